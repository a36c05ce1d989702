"""Turning to and fro about one pivot, with a rest at each end: what the camera's latency is measured with."""

from __future__ import annotations

import math

from pydantic import Field

from control.controllers.controller import Decision, Situation, controllers
from control.model import Pivot
from control.registry import Parameters

REST = 12
"""Decisions, one a camera frame, for which the field rests before it turns back: 0.2 s at 60 frames a second.
Longer than any camera is late, so that the picture has come to rest before the field goes the other way: what
is seen then never contradicts the field, and the rests show the play alone."""
SLOW = 0.5
"""Share of the rate at which every other pair of turns is made, so that a lag in time can be told from a play
in angle."""


class WiggleParameters(Parameters):
    turns: int = Field(
        default=24, ge=4, le=200, title="Turns", description="To and fro are two.",
        json_schema_extra={"unit": "1"},
    )  # fmt: skip
    turn_deg: float = Field(
        default=20.0, ge=8.0, le=60.0, title="Turn", description="From one end to the other.",
        json_schema_extra={"unit": "°"},
    )  # fmt: skip
    rate_deg_s: float = Field(
        default=40.0, gt=0.0, lt=360.0, title="Rate",
        description="How fast to swing, every other pair of turns half as fast; faster, a late camera loses the robot.",
        json_schema_extra={"unit": "°/s"},
    )  # fmt: skip


@controllers.register
class Wiggle:
    """The first turn is half as wide, so that the robot turns about the heading that it has at the start."""

    name = "wiggle"
    title = "Wiggle"
    summary = "Turns to and fro on one pivot; `pivotrig calibrate latency` learns from it."
    Parameters = WiggleParameters

    def __init__(self, parameters: WiggleParameters) -> None:
        self._turns = parameters.turns
        self._width = math.radians(parameters.turn_deg)
        self._rate = math.radians(parameters.rate_deg_s)
        self._begun = 0
        self._rested = 0
        self._pivot: Pivot | None = None

    def step(self, situation: Situation) -> Decision:
        """One turn of the body after the other; the walker says when one is complete."""
        pivot = self._pivot = self._pivot or situation.pivot
        if situation.may_switch:
            if self._rested < REST:
                self._rested += 1
                return Decision(pivot, 0.0, self._turn_width())
            if self._begun == self._turns:
                return Decision(pivot, 0.0, finished=True)
            self._begun += 1
            self._rested = 0
        return Decision(pivot, self._turn_rate(), self._turn_width())

    def _turn_rate(self) -> float:
        """Of the turn that has begun, rad/s, signed: left and right, each pair of turns at one rate."""
        number = self._begun - 1
        share = 1.0 if number // 2 % 2 == 0 else SLOW
        return math.copysign(share * self._rate, 1.0 if number % 2 == 0 else -1.0)

    def _turn_width(self) -> float:
        return 0.5 * self._width if self._begun <= 1 else self._width
