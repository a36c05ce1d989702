"""An Archimedean spiral, walked at constant speed."""

from __future__ import annotations

import math
from typing import Literal

from pydantic import Field, model_validator

from control.model import TURN
from control.registry import Parameters
from control.trajectories.fields import SMALLEST_MM, Direction, direction, millimetres, speed
from control.trajectories.trajectory import MM, passed, trajectories

ACCURACY = 1e-12
"""Newton's iteration ends when the length along the spiral is as close as this, m."""
MOST_ITERATIONS = 50


class SpiralParameters(Parameters):
    inner_radius_mm: float = millimetres(5.0, "Inner radius", least=0.0)
    outer_radius_mm: float = millimetres(42.0, "Outer radius", least=SMALLEST_MM)
    turns: float = Field(default=3.0, gt=0.0, le=50.0, title="Turns", json_schema_extra={"unit": "1"})
    way: Literal["out", "in"] = Field(default="in", title="Way", description="From the centre or towards it.")
    direction: Direction = direction()
    speed_mm_s: float = speed()

    @model_validator(mode="after")
    def _outside_is_farther_out(self) -> SpiralParameters:
        if not self.inner_radius_mm <= self.outer_radius_mm - SMALLEST_MM:
            raise ValueError(
                f"the inner radius, {self.inner_radius_mm:g} mm, must be at least {SMALLEST_MM:g} mm less "
                f"than the outer one, {self.outer_radius_mm:g} mm; a circle has both alike"
            )
        return self


@trajectories.register
class Spiral:
    """r = r0 + c a over the angle a; it begins or ends at the outer radius, straight below the centre."""

    name = "spiral"
    title = "Spiral"
    summary = "A spiral around the centre of the plate, inwards or outwards, at constant speed."
    Parameters = SpiralParameters
    closed = False

    def __init__(self, parameters: SpiralParameters) -> None:
        self._whole_turn = TURN * parameters.turns
        self._inner = parameters.inner_radius_mm * MM
        self._climb = (parameters.outer_radius_mm * MM - self._inner) / self._whole_turn
        self._inwards = parameters.way == "in"
        anticlockwise = parameters.direction == "anticlockwise"
        self._sense = 1.0 if anticlockwise != self._inwards else -1.0
        self._length = self._length_to(self._whole_turn)
        self.duration = self._length / (parameters.speed_mm_s * MM)

    def point(self, time: float) -> tuple[float, float]:
        walked = self._length * passed(time, self.duration, self.closed) / self.duration
        turned = self._turned_after(self._length - walked if self._inwards else walked)
        radius = self._inner + self._climb * turned
        angle = self._sense * (turned - self._whole_turn) - 0.5 * math.pi
        return radius * math.cos(angle), radius * math.sin(angle)

    def _turned_after(self, length: float) -> float:
        """The angle a from the inner end at which the spiral is `length` (m) long, rad, by Newton's method.

        The length is at least (r^2 - r0^2) / 2c, which gives a start beyond the answer; being convex in the
        angle, it is approached from there without overshoot.
        """
        farthest = math.sqrt(self._inner**2 + 2.0 * self._climb * max(0.0, length))
        turned = (farthest - self._inner) / self._climb
        for _ in range(MOST_ITERATIONS):
            beyond = self._length_to(turned) - length
            if beyond <= ACCURACY:
                break
            turned -= beyond / math.hypot(self._inner + self._climb * turned, self._climb)
        return max(0.0, turned)

    def _length_to(self, turned: float) -> float:
        """The integral of sqrt(r^2 + c^2) over the angle, from the inner end, m."""
        return self._primitive(self._inner + self._climb * turned) - self._primitive(self._inner)

    def _primitive(self, radius: float) -> float:
        c = self._climb
        return (radius * math.hypot(radius, c) / c + c * math.asinh(radius / c)) / 2.0
