"""What a reference path is, the registry of all of them, and the check that one stays on the plate."""

from __future__ import annotations

import math
from typing import Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from control.registry import Parameters, Registry

MM = 1e-3


class Path(Protocol):
    """A path with a clock of its own: one pass takes `duration` seconds; `point` accepts any time >= 0.

    A closed path goes round again after a pass, an open one stays at its end.
    """

    @property
    def duration(self) -> float: ...

    @property
    def closed(self) -> bool: ...

    def point(self, time: float) -> tuple[float, float]:
        """The desired point at `time` (s) of the path's clock, m."""
        ...


@runtime_checkable
class Cornered(Protocol):
    """A path that goes through certain points, which even the finest sampling could miss; (n, 2) m."""

    corners: NDArray[np.float64]


class Trajectory(Path, Protocol):
    """A path that can be chosen by name."""

    name: str
    title: str
    summary: str
    Parameters: type[Parameters]

    def __init__(self, parameters: Any) -> None: ...


trajectories: Registry[Trajectory] = Registry("trajectory")


class OutsideWorkspace(ValueError):
    """A path that the robot's centre must not follow."""


def points_of(path: Path, count: int = 600) -> NDArray[np.float64]:
    """One pass as (count, 2) points, m, evenly spaced in the path's time, both ends included."""
    times = np.linspace(0.0, path.duration, count)
    if path.closed:
        times[-1] = 0.0
    return np.array([path.point(t) for t in times.tolist()])


def length_of(path: Path) -> float:
    """Length of one pass, m."""
    steps = np.diff(points_of(path, 4000), axis=0)
    return float(np.hypot(steps[:, 0], steps[:, 1]).sum())


def check_inside(path: Path, half_size: float) -> None:
    """Refuse a path whose points leave the square workspace of half the size `half_size`, m."""
    points = points_of(path, 2000)
    if isinstance(path, Cornered):
        points = np.vstack([points, path.corners])
    worst = points[np.abs(points).max(axis=1).argmax()]
    reach = float(np.abs(worst).max())
    if not reach <= half_size:
        x, y = worst / MM
        raise OutsideWorkspace(
            f"the path reaches ({x:.1f}, {y:.1f}) mm, the workspace ends at ±{half_size / MM:.0f} mm; "
            "make it smaller or move it towards the centre"
        )


def passed(time: float, duration: float, closed: bool) -> float:
    """The time within one pass, s: wrapped for a closed path, held at the ends for an open one."""
    if closed:
        return math.fmod(time, duration) if time >= 0.0 else 0.0
    return min(max(time, 0.0), duration)
