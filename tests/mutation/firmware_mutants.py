"""Mutants of the firmware's core: each compiled, and put before the tests that compare it with the twin."""

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
HOST = ROOT / "tests" / "firmware" / "host"
TESTS = ("tests/firmware/test_firmware_core.py", "tests/firmware/test_firmware_core_parts.py")
LONGEST_TEST = 60.0
"""A mutant that has not failed by then, s, runs in circles, which the tests notice by their time limit: killed."""

COMPILER = ("g++", "-std=c++17", "-O1", "-fPIC", "-shared", "-w")


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
    core = SOURCES / "core"
    for path in sorted((*core.glob("*.cpp"), *core.glob("*.h"))):
        if path.name in ("contract.h", "flash.h"):
            continue  # generated and compared with its source; the AVR's way of reading flash
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
            for changed in changed_lines(line):
                yield Mutant(str(path.relative_to(ROOT)), number, line, changed)


def judge(wanted: list[Mutant], workers: int) -> Iterator[Outcome]:
    with tempfile.TemporaryDirectory() as scratch:
        original = _compile(SOURCES / "core", Path(scratch) / "original.so")
        if original is None or not _passes(original):
            raise SystemExit("the unchanged core does not pass its own tests; mend that first")
        code = original.read_bytes()
        with ThreadPoolExecutor(workers) as pool:
            yield from pool.map(lambda mutant: Outcome(mutant, _fate(mutant, code)), wanted)


def _fate(mutant: Mutant, original: bytes) -> str:
    with tempfile.TemporaryDirectory() as scratch:
        core = Path(scratch) / "core"
        shutil.copytree(SOURCES / "core", core)
        changed = core / Path(mutant.file).name
        lines = changed.read_text(encoding="utf-8").splitlines()
        lines[mutant.line - 1] = mutant.after
        changed.write_text("\n".join(lines) + "\n", encoding="utf-8")
        library = _compile(core, Path(scratch) / "original.so")
        if library is None or library.read_bytes() == original:
            return "invalid"
        return "survived" if _passes(library) else "killed"


def _compile(core: Path, library: Path) -> Path | None:
    """In a folder of its own, with the paths kept out of the result, so that equal code is equal bytes."""
    abi = (
        (HOST / "core_abi.cpp").read_text(encoding="utf-8").replace("../../../control/firmware/core", "core")
    )
    root = library.parent
    if core.parent != root:
        shutil.copytree(core, root / "core")
    (root / "core_abi.cpp").write_text(abi, encoding="utf-8")
    sources = sorted(str(path.relative_to(root)) for path in (root / "core").glob("*.cpp"))
    command = [*COMPILER, "-I.", "-Icore", *sources, "core_abi.cpp", "-o", library.name]
    done = subprocess.run(command, cwd=root, capture_output=True, check=False)
    return library if done.returncode == 0 else None


def _passes(library: Path) -> bool:
    environment = {
        **os.environ,
        "PIVOTRIG_CORE_LIBRARY": str(library),
        "PYTHONDONTWRITEBYTECODE": "1",
        "CI": "true",
    }
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", *TESTS]
    try:
        done = subprocess.run(
            command, cwd=ROOT, env=environment, capture_output=True, check=False, timeout=LONGEST_TEST
        )
    except subprocess.TimeoutExpired:
        return False
    return done.returncode == 0
