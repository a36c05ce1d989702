"""Which lines and branches of the firmware's core its differential tests do not reach.

    .venv/bin/python tests/firmware/core_coverage.py

prints one line for each; none is left when the core is covered.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from core_library import compile_core

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
TESTS = ("test_firmware_core.py", "test_firmware_core_obedience.py", "test_firmware_core_parts.py")


@dataclass(frozen=True, slots=True)
class Coverage:
    """Of the core: how much there is, and what was not reached, as `file:line what`."""

    lines: int
    branches: int
    missed: tuple[str, ...]


def measured(folder: Path) -> Coverage:
    """Compile the core with counters into `folder`, run the tests on it, read the counters."""
    library = folder / "core.so"
    compile_core(library, "core_abi.cpp", "-shared", "-fPIC", "-O0", "--coverage")
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-p", "no:xdist"]
    environment = {**os.environ, "PIVOTRIG_CORE_LIBRARY": str(library)}
    _run([*command, *(str(HERE / name) for name in TESTS)], environment)
    report = folder / "coverage.json"
    gcovr = [sys.executable, "-m", "gcovr", "--root", str(ROOT), "--object-directory", str(folder)]
    _run([*gcovr, "--filter", "control/firmware/portable/", "--json", str(report), str(folder)], environment)
    return _read(json.loads(report.read_text(encoding="utf-8")))


def _run(command: list[str], environment: dict[str, str]) -> None:
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"{command[2]} failed:\n{done.stdout[-4000:]}\n{done.stderr[-4000:]}")


def _read(report: dict) -> Coverage:
    lines = branches = 0
    missed: list[str] = []
    for file in report["files"]:
        for line in file["lines"]:
            place = f"{file['file']}:{line['line_number']}"
            lines += 1
            branches += len(line["branches"])
            if not line["count"]:
                missed.append(f"{place} never runs")
            missed += [f"{place} branch never taken" for branch in line["branches"] if not branch["count"]]
    return Coverage(lines, branches, tuple(missed))


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as name:
        found = measured(Path(name))
    print("\n".join(found.missed) or "every branch is taken")
    print(f"{found.lines} lines, {found.branches} branches, {len(found.missed)} missed")
    sys.exit(bool(found.missed))
