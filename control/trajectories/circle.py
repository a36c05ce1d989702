"""A circle, walked at constant speed."""

from __future__ import annotations

import math

from control.model import TURN
from control.registry import Parameters
from control.trajectories.fields import SMALLEST_MM, Direction, direction, millimetres, speed
from control.trajectories.trajectory import MM, trajectories


class CircleParameters(Parameters):
    radius_mm: float = millimetres(35.0, "Radius", least=SMALLEST_MM)
    centre_x_mm: float = millimetres(0.0, "Centre x")
    centre_y_mm: float = millimetres(0.0, "Centre y")
    speed_mm_s: float = speed()
    direction: Direction = direction()


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
