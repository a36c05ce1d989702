"""Changes the safety-critical code a line at a time and asks whether a test notices.

    python -m tests.mutation [python] [firmware] [--workers N] [--only PART_OF_A_FILE_NAME]

Prints each survivor with the reason why it may live, from `survivors.toml`; a survivor without one ends with status 1.
"""

from __future__ import annotations

import argparse
import os
import sys

from tests.mutation import firmware_mutants, python_mutants
from tests.mutation.accepted import Entry, entries


def main() -> None:
    parser = argparse.ArgumentParser(
        description="Mutation tests of limiter, arbiter, framing and firmware core."
    )
    parser.add_argument("parts", nargs="*", default=["python", "firmware"], choices=["python", "firmware"])
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--only", default="", help="firmware files whose name contains this")
    options = parser.parse_args()
    known = entries()
    open_questions = 0
    if "python" in options.parts:
        open_questions += _python(known, options.workers)
    if "firmware" in options.parts:
        open_questions += _firmware(known, options.workers, options.only)
    if open_questions:
        sys.exit(f"{open_questions} survivors without a reason: write the test that kills them")


def _python(known: list[Entry], workers: int) -> int:
    python_mutants.run(workers)
    living = list(python_mutants.survivors())
    print(f"python: {python_mutants.count()} mutants, {len(living)} survived")
    return sum(_explain(known, s.file, s.change, s.function) for s in living)


def _firmware(known: list[Entry], workers: int, only: str) -> int:
    wanted = [mutant for mutant in firmware_mutants.all_mutants() if only in mutant.file]
    fates: dict[str, int] = {"killed": 0, "survived": 0, "invalid": 0}
    unexplained = 0
    for outcome in firmware_mutants.judge(wanted, workers):
        fates[outcome.fate] += 1
        if outcome.fate == "survived":
            unexplained += _explain(
                known, outcome.mutant.file, outcome.mutant.change, f"line {outcome.mutant.line}"
            )
    print(
        f"firmware core: {len(wanted)} mutants, {fates['invalid']} that do not compile or change nothing, "
        f"{fates['survived']} survived"
    )
    return unexplained


def _explain(known: list[Entry], file: str, change: str, place: str) -> int:
    """Prints a survivor with its reason; 1 when it has none."""
    reason = next((entry.reason for entry in known if entry.covers(file, change, place)), "")
    print(f"{'accepted' if reason else 'OPEN'}: {file} {place}: {change}", flush=True)
    if reason:
        print(f"    {reason}", flush=True)
    return 0 if reason else 1


if __name__ == "__main__":
    main()
