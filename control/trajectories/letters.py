"""The letters S, M and U in one stroke each, walked at constant speed."""

from __future__ import annotations

import math
from typing import Literal

from pydantic import Field

from control.registry import Parameters
from control.trajectories.fields import SMALLEST_MM, millimetres, speed
from control.trajectories.pieces import Arc, Chain, Point, rounded
from control.trajectories.trajectory import MM, passed, trajectories

S_TURN = math.radians(240.0)
"""Each bow of the S turns by this: enough to close it visibly, too little to look like an 8."""
M_WIDTH, M_DIP, M_ROUNDING = 0.8, 0.55, 0.04
"""Width, depth of the middle and radius of the corners of the M, as shares of its height."""
U_WIDTH = 0.7
"""Width of the U as a share of its height."""


class LetterParameters(Parameters):
    letter: Literal["S", "M", "U"] = Field(default="S", title="Letter")
    height_mm: float = millimetres(80.0, "Height", "Before the corners are rounded.", least=SMALLEST_MM)
    centre_x_mm: float = millimetres(0.0, "Centre x")
    centre_y_mm: float = millimetres(0.0, "Centre y")
    speed_mm_s: float = speed()


@trajectories.register
class Letter:
    """A stroke of straight pieces and arcs without a kink."""

    name = "letter"
    title = "Letter"
    summary = "S, M or U in one smooth stroke at constant speed."
    Parameters = LetterParameters
    closed = False

    def __init__(self, parameters: LetterParameters) -> None:
        self._stroke = STROKES[parameters.letter](parameters.height_mm * MM)
        self._centre = parameters.centre_x_mm * MM, parameters.centre_y_mm * MM
        self._speed = parameters.speed_mm_s * MM
        self.duration = self._stroke.length / self._speed

    def point(self, time: float) -> tuple[float, float]:
        x, y = self._stroke.at(self._speed * passed(time, self.duration, self.closed))
        return self._centre[0] + x, self._centre[1] + y


def _s(height: float) -> Chain:
    """From the lower left to the upper right."""
    radius = 0.25 * height
    lower = Arc((0.0, -radius), radius, 0.5 * math.pi - S_TURN, S_TURN)
    upper = Arc((0.0, radius), radius, -0.5 * math.pi, -S_TURN)
    return Chain([lower, upper])


def _m(height: float) -> Chain:
    """From the lower left to the lower right."""
    half, right = 0.5 * height, 0.5 * M_WIDTH * height
    dip = half - M_DIP * height
    corners: list[Point] = [(-right, -half), (-right, half), (0.0, dip), (right, half), (right, -half)]
    return rounded(corners, M_ROUNDING * height, closed=False)


def _u(height: float) -> Chain:
    """From the upper left to the upper right."""
    half, right = 0.5 * height, 0.5 * U_WIDTH * height
    corners: list[Point] = [(-right, half), (-right, -half), (right, -half), (right, half)]
    return rounded(corners, right, closed=False)


STROKES = {"S": _s, "M": _m, "U": _u}
