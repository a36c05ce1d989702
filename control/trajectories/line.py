"""A straight line, walked once at constant speed."""

from __future__ import annotations

import math

from pydantic import model_validator

from control.registry import Parameters
from control.trajectories.fields import SMALLEST_MM, millimetres, speed
from control.trajectories.trajectory import MM, passed, trajectories


class LineParameters(Parameters):
    start_x_mm: float = millimetres(0.0, "Start x")
    start_y_mm: float = millimetres(-40.0, "Start y")
    end_x_mm: float = millimetres(0.0, "End x")
    end_y_mm: float = millimetres(40.0, "End y")
    speed_mm_s: float = speed()

    @model_validator(mode="after")
    def _has_a_length(self) -> LineParameters:
        if not math.hypot(self.end_x_mm - self.start_x_mm, self.end_y_mm - self.start_y_mm) >= SMALLEST_MM:
            raise ValueError(
                f"the line must be at least {SMALLEST_MM:g} mm long, but its ends are the same; move one of them"
            )
        return self


@trajectories.register
class Line:
    """From the start to the end."""

    name = "line"
    title = "Line"
    summary = "A straight line at constant speed; the reference waits at its end."
    Parameters = LineParameters
    closed = False

    def __init__(self, parameters: LineParameters) -> None:
        self._start = parameters.start_x_mm * MM, parameters.start_y_mm * MM
        self._end = parameters.end_x_mm * MM, parameters.end_y_mm * MM
        self.duration = math.dist(self._start, self._end) / (parameters.speed_mm_s * MM)

    def point(self, time: float) -> tuple[float, float]:
        share = passed(time, self.duration, self.closed) / self.duration
        (x0, y0), (x1, y1) = self._start, self._end
        return x0 + share * (x1 - x0), y0 + share * (y1 - y0)
