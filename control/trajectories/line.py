"""A straight line, walked once at constant speed."""

from __future__ import annotations

import math

from pydantic import Field, model_validator

from control.registry import Parameters
from control.trajectories.trajectory import MM, passed, trajectories


class LineParameters(Parameters):
    start_x_mm: float = Field(
        default=0.0, ge=-500.0, le=500.0, title="Start x", json_schema_extra={"unit": "mm"}
    )
    start_y_mm: float = Field(
        default=-40.0, ge=-500.0, le=500.0, title="Start y", json_schema_extra={"unit": "mm"}
    )
    end_x_mm: float = Field(default=0.0, ge=-500.0, le=500.0, title="End x", json_schema_extra={"unit": "mm"})
    end_y_mm: float = Field(
        default=40.0, ge=-500.0, le=500.0, title="End y", json_schema_extra={"unit": "mm"}
    )
    speed_mm_s: float = Field(
        default=3.0, gt=0.0, le=50.0, title="Speed", description="Along the path, at a path step of 0.1 s.",
        json_schema_extra={"unit": "mm/s"},
    )  # fmt: skip

    @model_validator(mode="after")
    def _has_a_length(self) -> LineParameters:
        if (self.start_x_mm, self.start_y_mm) == (self.end_x_mm, self.end_y_mm):
            raise ValueError("the line starts where it ends; move one of its ends")
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
