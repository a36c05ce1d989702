"""Mutation run of the firmware's core: each small change of its sources must make a differential test fail.

    .venv/bin/python tests/firmware/core_mutants.py [--share 1/4] [FILE ...]

prints every survivor with its line; FILE limits the run to some of the core's files, --share to every n-th mutant.
"""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from core_library import SOURCES

from control.firmware.build import core_sources

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
TESTS = ("test_firmware_core.py", "test_firmware_core_parts.py", "test_firmware_core_exchanges.py")
LONGEST = 60.0
"""A mutant whose tests take longer than this, s, hangs, which is noticed as well."""

RULES = (
    *(
        (r" < ", " <= "),
        (r" <= ", " < "),
        (r" > ", " >= "),
        (r" >= ", " > "),
        (r" == ", " != "),
        (r" != ", " == "),
    ),
    *((r" && ", " || "), (r" \|\| ", " && "), (r" \+ ", " - "), (r" - ", " + "), (r" \* ", " + ")),
    *((r" << ", " >> "), (r" >> ", " << "), (r" \| ", " & "), (r" & ", " | "), (r" \^ ", " | ")),
    *((r"\+\+", "--"), (r"--", "++"), (r"!(?=[a-z])", ""), (r"\btrue\b", "false"), (r"\bfalse\b", "true")),
    *((r"(?<=[ (\[<])0(?=[;,)\]])", "1"), (r"(?<=[ (\[<])1(?=[;,)\]])", "2"), (r"(?<![\w.])-(?=[a-z])", "")),
    (r"^    +[a-z_.]+\([^)]*\);$", ";"),
)
"""What is replaced by what: comparisons, logic, arithmetic, counters, constants, calls."""


@dataclass(frozen=True, slots=True)
class Mutant:
    source: Path
    line: int
    before: str
    after: str

    def __str__(self) -> str:
        return f"{self.source.name}:{self.line}: {self.before.strip()}  ->  {self.after.strip()}"

    def text(self) -> str:
        lines = self.source.read_text(encoding="utf-8").splitlines()
        lines[self.line - 1] = self.after
        return "\n".join(lines) + "\n"


def mutants_of(source: Path) -> Iterator[Mutant]:
    for number, line in enumerate(source.read_text(encoding="utf-8").splitlines(), start=1):
        code = line.split("//")[0].rstrip()
        if code.lstrip().startswith(("#", "static_assert", "constexpr", "template")):
            continue
        for pattern, replacement in RULES:
            for match in re.finditer(pattern, code):
                yield Mutant(source, number, line, code[: match.start()] + replacement + code[match.end() :])


class Bench:
    """Objects of the unchanged core in a folder, and libraries with one object exchanged."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        for source in (*core_sources(), SOURCES / "core_abi.cpp"):
            self._compile(source, folder / f"{source.stem}.o")

    def survives(self, mutant: Mutant) -> bool:
        """Whether it compiles and no test notices."""
        changed = self._folder / f"mutant_{mutant.source.name}"
        changed.write_text(mutant.text(), encoding="utf-8")
        object_ = self._folder / "mutant.o"
        if not self._compile(changed, object_, f"-I{mutant.source.parent}"):
            return False
        others = [o for o in self._folder.glob("*.o") if o.stem not in ("mutant", mutant.source.stem)]
        library = self._folder / "mutant.so"
        subprocess.run(["g++", "-shared", "-o", library, object_, *others], check=True)
        return self._tests_pass(library)

    @staticmethod
    def _compile(source: Path, target: Path, *flags: str) -> bool:
        command = [
            "g++",
            "-std=c++17",
            "-fno-exceptions",
            "-fPIC",
            "-O1",
            "-w",
            *flags,
            "-c",
            source,
            "-o",
            target,
        ]
        return subprocess.run(command, capture_output=True, check=False).returncode == 0

    @staticmethod
    def _tests_pass(library: Path) -> bool:
        command = [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", "-p", "no:xdist"]
        environment = {**os.environ, "PIVOTRIG_CORE_LIBRARY": str(library), "CI": "true"}
        tests = [str(HERE / name) for name in TESTS]
        try:
            done = subprocess.run(
                [*command, *tests],
                cwd=ROOT,
                env=environment,
                capture_output=True,
                timeout=LONGEST,
                check=False,
            )
        except subprocess.TimeoutExpired:
            return False
        return done.returncode == 0


def main() -> None:
    parser = argparse.ArgumentParser(description="Mutation run of the firmware's core.")
    parser.add_argument("files", nargs="*", help="names of the core's sources; all of them by default")
    parser.add_argument("--share", default="1/1", help="k/n: the k-th of every n mutants")
    options = parser.parse_args()
    turn, every = (int(word) for word in options.share.split("/"))
    sources = [s for s in core_sources() if not options.files or s.name in options.files]
    chosen = [m for source in sources for m in mutants_of(source)][turn - 1 :: every]
    survivors = 0
    with tempfile.TemporaryDirectory() as name:
        bench = Bench(Path(name))
        for mutant in chosen:
            if bench.survives(mutant):
                survivors += 1
                print(mutant, flush=True)
    print(f"{len(chosen)} mutants, {survivors} survivors")


if __name__ == "__main__":
    main()
