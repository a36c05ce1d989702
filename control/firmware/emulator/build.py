"""Compiles `pivot_board`, the emulated board, with the host's C compiler and libsimavr."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

SOURCES = Path(__file__).parent
PROGRAM = "pivot_board"

_FLAGS = ("-std=c11", "-D_GNU_SOURCE", "-O2", "-Wall", "-Wextra", "-Werror")
_LIBRARIES = ("-lsimavr", "-lelf", "-lutil", "-lm")


class EmulatorMissing(OSError):
    """The emulated board cannot be built; the text says what to install."""


def build_emulator(folder: Path) -> Path:
    """The program in `folder`, compiled unless it is newer than its sources."""
    program = folder / PROGRAM
    sources = sorted(SOURCES.glob("*.c"))
    if not is_stale(program, [*sources, *SOURCES.glob("*.h")]):
        return program
    compiler = shutil.which("gcc")
    if compiler is None:
        raise EmulatorMissing("there is no C compiler for the emulated board: apt-get install gcc libc6-dev")
    folder.mkdir(parents=True, exist_ok=True)
    fresh = program.with_suffix(".new")
    command = [compiler, *_FLAGS, *map(str, sources), "-o", str(fresh), *_LIBRARIES]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise EmulatorMissing(f"the emulated board does not compile: {_advice(done.stderr)}")
    return fresh.replace(program)


def is_stale(product: Path, sources: list[Path]) -> bool:
    """Whether one of the sources is younger than what has been made of them, or nothing has."""
    if not product.exists():
        return True
    made = product.stat().st_mtime
    return any(source.stat().st_mtime > made for source in sources)


def _advice(complaint: str) -> str:
    if "simavr" in complaint or "libelf" in complaint or "-lelf" in complaint:
        return f"apt-get install libsimavr-dev libelf-dev\n{complaint.strip()[:2000]}"
    return complaint.strip()[:2000]
