"""What the last digit of a result rests on: versions, and how this computer rounds its sines."""

from __future__ import annotations

import hashlib
import math
import platform
from dataclasses import dataclass
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import numpy as np

PACKAGES = ("pivotrig", "numpy", "scipy", "numba", "llvmlite", "mujoco")
"""Those whose version may change a digit."""
PROBES = 500
"""Arguments at which the functions are tried: enough for libraries that round differently to give themselves away."""
ABSENT = "not installed"
SOURCES = Path(__file__).parents[1]
"""The folder of all that a run is made of."""


@dataclass(frozen=True, slots=True)
class Ground:
    """Equal grounds give equal results, bit for bit. versions: by package.  rounding: of the elementary functions."""

    versions: tuple[tuple[str, str], ...]
    rounding: str

    def differences(self, other: Ground) -> list[str]:
        """In words; empty for equal ones. other: the worker's."""
        theirs = dict(other.versions)
        found = [
            f"{name} is {theirs.get(name, ABSENT)} there and {here} here"
            for name, here in self.versions
            if theirs.get(name, ABSENT) != here
        ]
        if self.rounding != other.rounding:
            found.append("its processor or C library rounds sines and roots differently")
        return found


@cache
def ground() -> Ground:
    """That of this process."""
    packages = ((name, _version(name)) for name in PACKAGES)
    versions = ("Python", platform.python_version()), *packages, ("pivotrig's source text", text_of(SOURCES))
    return Ground(versions, _rounding())


def text_of(folder: Path) -> str:
    """A digest of all Python files in it: a version's number does not tell of a line that was edited since."""
    digest = hashlib.sha256()
    for file in sorted(folder.rglob("*.py")):
        digest.update(file.relative_to(folder).as_posix().encode() + b"\0" + file.read_bytes() + b"\0")
    return digest.hexdigest()[:12]


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return ABSENT


def _rounding() -> str:
    values = np.random.default_rng(0).uniform(0.01, 7.0, PROBES)
    functions = (math.sin, math.cos, math.tan, math.exp, math.log, math.sqrt, math.atan)
    scalar = np.array([[f(x) for f in functions] for x in values.tolist()])
    angles = np.array([math.atan2(math.sin(x), math.cos(x) + 0.3) for x in values.tolist()])
    arrays = (np.sin(values), np.cos(values), np.exp(values), np.arctan2(values, 2.0), np.hypot(values, 1.5))
    digest = hashlib.sha256()
    for part in (scalar, angles, *arrays):
        digest.update(part.tobytes())
    return digest.hexdigest()
