"""A circle, walked at constant speed."""

from __future__ import annotations

import math
from typing import Literal

from pydantic import Field

from control.model import TURN
from control.registry import Parameters
from control.trajectories.trajectory import MM, trajectories


class CircleParameters(Parameters):
    radius_mm: float = Field(default=35.0, gt=0.0, le=500.0, title="Radius", json_schema_extra={"unit": "mm"})
    centre_x_mm: float = Field(
        default=0.0, ge=-500.0, le=500.0, title="Centre x", json_schema_extra={"unit": "mm"}
    )
    centre_y_mm: float = Field(
        default=0.0, ge=-500.0, le=500.0, title="Centre y", json_schema_extra={"unit": "mm"}
    )
    speed_mm_s: float = Field(
        default=3.0, gt=0.0, le=50.0, title="Speed", description="Along the path, at a path step of 0.1 s.",
        json_schema_extra={"unit": "mm/s"},
    )  # fmt: skip
    direction: Literal["clockwise", "anticlockwise"] = Field(default="clockwise", title="Direction")


@trajectories.register
class Circle:
    """Starts at the lowest point of the circle."""

    name = "circle"
    title = "Circle"
    summary = "A circle at constant speed, starting at its lowest point."
    Parameters = CircleParameters
    closed = True

    def __init__(self, parameters: CircleParameters) -> None:
        self._radius = parameters.radius_mm * MM
        self._centre = parameters.centre_x_mm * MM, parameters.centre_y_mm * MM
        self._sense = 1.0 if parameters.direction == "anticlockwise" else -1.0
        self.duration = TURN * self._radius / (parameters.speed_mm_s * MM)

    def point(self, time: float) -> tuple[float, float]:
        angle = self._sense * TURN * time / self.duration - math.pi / 2.0
        x, y = self._centre
        return x + self._radius * math.cos(angle), y + self._radius * math.sin(angle)
