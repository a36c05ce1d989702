"""What is shown of one or two recordings at one instant, and how that looks in the scene."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from control.model import Pose
from control.snapshot import ZERO, Vector
from server.recording.reading.paths import Path, path_at
from server.recording.reading.recording import Picture
from server.scene.geometry import SceneGeometry
from server.scene.plate_pictures import Photograph
from server.scene.robot import ShownRobot
from server.scene.scene import View
from server.scene.shapes import FULL_FIELD

MM = 1e-3
TRAIL = 60.0
"""The trail reaches back this long, s, as the live one does."""

Tick = Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Instant:
    """at: time since the start of the run, s.  ticks: of each recording, as `GET /state` has them, None before the
    first one."""

    at: float
    ticks: Sequence[Tick | None]


@dataclass(frozen=True, slots=True)
class Course:
    """Where a run went. paths: that it was to walk.  times: (n,) s since its start.  places: (n, 2) m."""

    paths: Sequence[Path]
    times: NDArray[np.float64]
    places: NDArray[np.float64]

    def until(self, at: float) -> NDArray[np.float64]:
        """(k, 2) the places of the last minute before `at`, m."""
        first, last = np.searchsorted(self.times, (at - TRAIL, at), side="right")
        return self.places[first:last]


class ReplaySource:
    """How an instant looks.

    geometry: of the first run's rig.  newest: its picture that was shown last, None for none.
    full_field: the end of the field's scale, T.
    """

    def __init__(
        self,
        geometry: SceneGeometry,
        courses: Sequence[Course],
        newest: Callable[[], Picture | None] = lambda: None,
        full_field: float = FULL_FIELD,
    ) -> None:
        self.geometry = geometry
        self._courses = courses
        self._newest = newest
        self._full_field = full_field

    def view(self, instant: Instant) -> View:
        pairs = zip(instant.ticks, self._courses, strict=True)
        robots = [robot_of(tick, course, instant.at) for tick, course in pairs]
        return View(self.geometry, currents_of(instant.ticks[0]), robots, self._full_field)

    def photograph(self) -> Photograph | None:
        picture = self._newest()
        return None if picture is None else Photograph(picture.jpeg, picture.captured_s)


def robot_of(tick: Tick | None, course: Course, at: float) -> ShownRobot:
    if tick is None:
        return ShownRobot(None, 1, 0.0, path_at(course.paths, at), course.places[:0])
    pivot = -1 if tick["command"]["pivot"] == -1 else 1
    tilt = math.radians(tick["body_tilt_deg"] or 0.0)
    path = path_at(course.paths, at)
    return ShownRobot(
        pose_of(tick["pose"]), pivot, tilt, path, course.until(at), target_of(tick["reference"])
    )


def pose_of(pose: Mapping[str, float | None] | None) -> Pose | None:
    if pose is None:
        return None
    x, y, heading = pose["x_mm"], pose["y_mm"], pose["heading_deg"]
    if x is None or y is None or heading is None:
        return None
    return Pose(x * MM, y * MM, math.radians(heading))


def target_of(reference: Mapping[str, float | None] | None) -> tuple[float, float] | None:
    """Where the robot should have been, m."""
    if reference is None or reference["x_mm"] is None or reference["y_mm"] is None:
        return None
    return reference["x_mm"] * MM, reference["y_mm"] * MM


def currents_of(tick: Tick | None) -> Vector:
    """The commanded currents, A."""
    if tick is None:
        return ZERO
    x, y, z = (value or 0.0 for value in tick["currents_A"])
    return x, y, z
