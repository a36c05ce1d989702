"""A chain of straight pieces through given points, walked at constant speed."""

from __future__ import annotations

import bisect
import itertools
import math

from pydantic import Field, field_validator

from control.registry import Parameters
from control.trajectories.trajectory import MM, passed, trajectories


class WaypointsParameters(Parameters):
    points_mm: list[tuple[float, float]] = Field(
        default=[(-35.0, -35.0), (-35.0, 35.0), (35.0, 35.0), (35.0, -35.0)],
        min_length=2,
        max_length=10_000,
        title="Points",
        description="[x, y] pairs in the workspace, in the order of the walk.",
        json_schema_extra={"unit": "mm"},
    )
    closed: bool = Field(default=True, title="Closed", description="Return to the first point.")
    speed_mm_s: float = Field(
        default=3.0, gt=0.0, le=50.0, title="Speed", description="Along the path, at a path step of 0.1 s.",
        json_schema_extra={"unit": "mm/s"},
    )  # fmt: skip

    @field_validator("points_mm")
    @classmethod
    def _points_differ(cls, points: list[tuple[float, float]]) -> list[tuple[float, float]]:
        for number, (here, there) in enumerate(itertools.pairwise(points), start=1):
            if here == there:
                raise ValueError(
                    f"points {number} and {number + 1} are the same: {here} mm; drop one of them"
                )
        return points


@trajectories.register
class Waypoints:
    """The polyline through the points, parametrised by its length."""

    name = "waypoints"
    title = "Waypoints"
    summary = "Straight pieces through your points at constant speed."
    Parameters = WaypointsParameters

    def __init__(self, parameters: WaypointsParameters) -> None:
        self.closed = parameters.closed
        points = [(x * MM, y * MM) for x, y in parameters.points_mm]
        self._points = [*points, points[0]] if self.closed and points[0] != points[-1] else points
        lengths = [math.dist(here, there) for here, there in itertools.pairwise(self._points)]
        speed = parameters.speed_mm_s * MM
        self._times = [0.0, *(length / speed for length in itertools.accumulate(lengths))]
        self.duration = self._times[-1]

    def point(self, time: float) -> tuple[float, float]:
        within = passed(time, self.duration, self.closed)
        piece = min(bisect.bisect_right(self._times, within), len(self._times) - 1) - 1
        share = (within - self._times[piece]) / (self._times[piece + 1] - self._times[piece])
        (x0, y0), (x1, y1) = self._points[piece : piece + 2]
        return x0 + share * (x1 - x0), y0 + share * (y1 - y0)
