"""A path through given points, straight from one to the next or as a smooth curve, walked at constant speed."""

from __future__ import annotations

import itertools
import math
from typing import Literal

import numpy as np
from pydantic import Field, field_validator, model_validator

from control.registry import Parameters
from control.trajectories.fields import SAME_POINT_MM, speed
from control.trajectories.pieces import Chain, Straight
from control.trajectories.spline import Spline
from control.trajectories.trajectory import MM, passed, trajectories

Smoothing = Literal["polyline", "spline"]


class WaypointsParameters(Parameters):
    points_mm: list[tuple[float, float]] = Field(
        default=[(-35.0, -35.0), (-35.0, 35.0), (35.0, 35.0), (35.0, -35.0)],
        min_length=2,
        max_length=2_000,
        title="Points",
        description="[x, y] pairs in the workspace, in the order of the walk.",
        json_schema_extra={"unit": "mm"},
    )
    closed: bool = Field(default=True, title="Closed", description="Return to the first point.")
    kind: Smoothing = Field(
        default="polyline", title="Between points", description="Straight pieces, or a smooth curve."
    )
    speed_mm_s: float = speed()

    @field_validator("points_mm")
    @classmethod
    def _points_are_on_a_table(cls, points: list[tuple[float, float]]) -> list[tuple[float, float]]:
        for number, point in enumerate(points, start=1):
            if not all(-500.0 <= coordinate <= 500.0 for coordinate in point):
                raise ValueError(f"point {number} is {point} mm; allowed: -500 to 500 mm in x and y")
        return points

    @field_validator("points_mm")
    @classmethod
    def _points_differ(cls, points: list[tuple[float, float]]) -> list[tuple[float, float]]:
        for number, (here, there) in enumerate(itertools.pairwise(points), start=1):
            if not math.dist(here, there) >= SAME_POINT_MM:
                raise ValueError(
                    f"points {number} and {number + 1} are the same: {here} mm; drop one of them"
                )
        return points

    @model_validator(mode="after")
    def _has_an_inside(self) -> WaypointsParameters:
        if self.closed and self.kind == "spline" and len(loop(self.points_mm)) < 4:
            raise ValueError("a closed spline needs at least three different points; add one or open it")
        return self


@trajectories.register
class Waypoints:
    """The polyline or spline through the points, parametrised by its length."""

    name = "waypoints"
    title = "Waypoints"
    summary = "Through your points at constant speed, in straight pieces or as a smooth curve."
    Parameters = WaypointsParameters

    def __init__(self, parameters: WaypointsParameters) -> None:
        self.closed = parameters.closed
        chosen = loop(parameters.points_mm) if self.closed else parameters.points_mm
        points = [(x * MM, y * MM) for x, y in chosen]
        self.corners = np.array(points)
        self._curve = (
            Spline(points, closed=self.closed)
            if parameters.kind == "spline"
            else Chain([Straight(here, there) for here, there in itertools.pairwise(points)])
        )
        self._speed = parameters.speed_mm_s * MM
        self.duration = self._curve.length / self._speed

    def point(self, time: float) -> tuple[float, float]:
        return self._curve.at(self._speed * passed(time, self.duration, self.closed))


def loop(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """The points with the first one once more at the end, where it is not there yet."""
    returns = math.dist(points[0], points[-1]) < SAME_POINT_MM
    return [*points[:-1], points[0]] if returns else [*points, points[0]]
