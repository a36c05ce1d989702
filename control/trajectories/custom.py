"""Paths that somebody drew or sent, made trajectories of their own under a name."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from control.registry import Parameters
from control.trajectories.fields import speed as speed_field
from control.trajectories.trajectory import MM, trajectories
from control.trajectories.waypoints import Smoothing, Waypoints, WaypointsParameters

MOST_PATHS = 200
"""Saved paths that one session may hold."""


class TooManyPaths(ValueError):
    """The session holds as many saved paths as it may."""


def save_path(
    name: str, points: NDArray[np.float64], closed: bool, speed: float, kind: Smoothing = "polyline"
) -> None:
    """Register a path through `points` ((n, 2), m) walked at `speed` (m/s) as a trajectory `name`.

    Raises ValueError for a name that is taken, `TooManyPaths`, and pydantic's ValidationError for bad points.
    """
    if sum(issubclass(entry, SavedPath) for entry in trajectories.values()) >= MOST_PATHS:
        raise TooManyPaths(f"{MOST_PATHS} paths are saved already, which is the limit of a session")
    mm = [(float(x), float(y)) for x, y in np.asarray(points) / MM]
    whole = WaypointsParameters(points_mm=mm, closed=closed, kind=kind, speed_mm_s=speed / MM)
    trajectories.register(_entry(name, whole))


class SavedPath(Waypoints):
    """Waypoints whose points are fixed; only the speed is left to choose."""

    whole: WaypointsParameters

    def __init__(self, parameters: Parameters) -> None:
        super().__init__(self.whole.model_copy(update=parameters.model_dump()))


def _entry(name: str, whole: WaypointsParameters) -> type[SavedPath]:
    class SpeedOnly(Parameters):
        speed_mm_s: float = speed_field(whole.speed_mm_s)

    summary = f"A saved path of {len(whole.points_mm)} points."
    body = {"name": name, "title": name, "summary": summary, "Parameters": SpeedOnly, "whole": whole}
    return type("SavedPath", (SavedPath,), body)
