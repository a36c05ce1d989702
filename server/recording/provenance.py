"""With what a recording was made: versions of the program and its libraries, its git revision, the computer."""

from __future__ import annotations

import os
import platform
import sys
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

LIBRARIES = ("numpy", "scipy", "opencv-python-headless", "filterpy", "magpylib", "pydantic", "numba", "mcap")
"""Those that the figures of a run depend on, and the one that the file does."""
SOURCE = Path(__file__).resolve().parents[2]
HASH_LENGTH = 40


@cache
def versions() -> dict[str, str]:
    """pivotrig, python and the libraries, by name."""
    return {"pivotrig": version("pivotrig"), "python": platform.python_version(), **_libraries()}


def _libraries() -> dict[str, str]:
    found: dict[str, str] = {}
    for name in LIBRARIES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:  # numba is only there where studies are
            continue
    return found


@cache
def computer() -> dict[str, str | int | None]:
    system = os.uname()
    return {
        "name": system.nodename,
        "system": f"{system.sysname} {system.release}",
        "machine": system.machine,
        "processors": os.cpu_count(),
        "byte_order": sys.byteorder,
    }


@cache
def revision() -> str | None:
    """The commit that is checked out where the program runs from; None for an installed one."""
    try:
        return _revision(SOURCE / ".git")
    except OSError:
        return None


def _revision(git: Path) -> str | None:
    if git.is_file():  # a worktree names its folder
        git = git.parent / git.read_text().removeprefix("gitdir:").strip()
    head = (git / "HEAD").read_text().strip()
    if not head.startswith("ref:"):
        return _hash(head)
    name = head.removeprefix("ref:").strip()
    common = git / "commondir"
    git = (git / common.read_text().strip()) if common.is_file() else git
    if (git / name).is_file():
        return _hash((git / name).read_text().strip())
    packed = (git / "packed-refs").read_text().splitlines()
    return next((_hash(line.partition(" ")[0]) for line in packed if line.endswith(f" {name}")), None)


def _hash(text: str) -> str | None:
    return text if len(text) == HASH_LENGTH and not text.strip("0123456789abcdef") else None
