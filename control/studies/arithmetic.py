"""What the last digit of a result rests on: versions, and how this computer rounds its sines."""

from __future__ import annotations

import hashlib
import math
import platform
from dataclasses import dataclass
from functools import cache
from importlib.metadata import PackageNotFoundError, version

import numpy as np

PACKAGES = ("pivotrig", "numpy", "scipy", "numba", "llvmlite", "mujoco")
"""Those whose version may change a digit."""
PROBES = 500
"""Arguments at which the functions are tried: enough for libraries that round differently to give themselves away."""
ABSENT = "not installed"


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
    versions = (("Python", platform.python_version()), *((name, _version(name)) for name in PACKAGES))
    return Ground(versions, _rounding())


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
