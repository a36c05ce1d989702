"""Mutants of the firmware's portable part: each compiled, and put before the tests that compare it with the twin."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from control.firmware.build import SOURCES
from tests.mutation.firmware_rules import changed_lines

ROOT = Path(__file__).parents[2]
PORTABLE = SOURCES / "portable"
ABI = ROOT / "tests" / "firmware" / "host" / "core_abi.cpp"
TESTS = tuple(
    f"tests/firmware/test_firmware_core{part}.py" for part in ("", "_obedience", "_parts", "_exchanges")
)
LONGEST_TEST = 60.0
"""A mutant that has not failed by then, s, runs in circles; the tests' own time limit would notice: killed."""

COMPILER = ("g++", "-std=c++17", "-fno-exceptions", "-O1", "-fPIC", "-w")


@dataclass(frozen=True, slots=True)
class Mutant:
    """One changed line; `file` relative to the repository."""

    file: str
    line: int
    before: str
    after: str

    @property
    def change(self) -> str:
        return f"{self.before.strip()} -> {self.after.strip() or '(nothing)'}"


@dataclass(frozen=True, slots=True)
class Outcome:
    """killed, survived, or invalid: does not compile, or compiles to the very same instructions."""

    mutant: Mutant
    fate: str


def all_mutants() -> Iterator[Mutant]:
    for path in sorted((*PORTABLE.glob("*.cpp"), *PORTABLE.glob("*.h"))):
        if path.name in ("contract.h", "flash.h"):
            continue  # generated and compared with its source; the AVR's way of reading flash
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
            for changed in changed_lines(line):
                yield Mutant(str(path.relative_to(ROOT)), number, line, changed)


def judge(wanted: list[Mutant], workers: int) -> Iterator[Outcome]:
    """The fate of each, in their order."""
    with tempfile.TemporaryDirectory() as name:
        bench = _Bench(Path(name))
        with ThreadPoolExecutor(workers) as pool:
            yield from pool.map(bench.judge, wanted)


class _Bench:
    """Objects of the unchanged sources; a mutant compiles anew only what its change can reach."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        shutil.copytree(PORTABLE, folder / "portable")
        abi = ABI.read_text(encoding="utf-8").replace("../../../control/firmware/portable", "portable")
        (folder / "abi.cpp").write_text(abi, encoding="utf-8")
        self._sources = [*sorted((folder / "portable").glob("*.cpp")), folder / "abi.cpp"]
        self._objects = {source.stem: _compiled(source, folder) for source in self._sources}
        library = folder / "unchanged.so"
        _link([*self._objects.values()], library)
        if None in self._objects.values() or not _passes(library):
            raise SystemExit("the unchanged core does not pass its own tests; mend that first")

    def judge(self, mutant: Mutant) -> Outcome:
        with tempfile.TemporaryDirectory(dir=self._folder) as name:
            return Outcome(mutant, self._fate(mutant, Path(name)))

    def _fate(self, mutant: Mutant, scratch: Path) -> str:
        shutil.copytree(self._folder / "portable", scratch / "portable")
        shutil.copy(self._folder / "abi.cpp", scratch)
        changed = scratch / "portable" / Path(mutant.file).name
        lines = changed.read_text(encoding="utf-8").splitlines()
        lines[mutant.line - 1] = mutant.after
        changed.write_text("\n".join(lines) + "\n", encoding="utf-8")
        return self._fate_of(self._recompiled(changed, scratch), scratch / "mutant.so")

    def _fate_of(self, objects: dict[str, Path | None], library: Path) -> str:
        if None in objects.values() or all(_same(objects[stem], self._objects[stem]) for stem in objects):
            return "invalid"
        _link([*(self._objects | objects).values()], library)
        return "survived" if _passes(library) else "killed"

    def _recompiled(self, changed: Path, scratch: Path) -> dict[str, Path | None]:
        if changed.suffix == ".cpp":
            return {changed.stem: _compiled(changed, scratch)}
        sources = [*(scratch / "portable").glob("*.cpp"), scratch / "abi.cpp"]
        return {source.stem: _compiled(source, scratch) for source in sources}


def _compiled(source: Path, root: Path) -> Path | None:
    """Named relative to `root`, so that equal code is equal bytes; None when it does not compile."""
    made = root / f"{source.stem}.o"
    command = [*COMPILER, "-I.", "-Iportable", "-c", str(source.relative_to(root)), "-o", made.name]
    done = subprocess.run(command, cwd=root, capture_output=True, check=False)
    return made if done.returncode == 0 else None


def _same(one: Path | None, other: Path | None) -> bool:
    return one is not None and other is not None and one.read_bytes() == other.read_bytes()


def _link(objects: list[Path | None], library: Path) -> None:
    made = [str(path) for path in objects if path is not None]
    subprocess.run(["g++", "-shared", *made, "-o", str(library)], check=True)


def _passes(library: Path) -> bool:
    environment = {**os.environ, "PIVOTRIG_CORE_LIBRARY": str(library), "CI": "true"}
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", "-p", "no:xdist", *TESTS]
    try:
        done = subprocess.run(
            command, cwd=ROOT, env=environment, capture_output=True, check=False, timeout=LONGEST_TEST
        )
    except subprocess.TimeoutExpired:
        return False
    return done.returncode == 0
