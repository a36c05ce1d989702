"""A walk that shows what a pivot switch does: straight legs out and back, in directions all round."""

from __future__ import annotations

import math
from dataclasses import replace

from pydantic import Field

from control.controllers.controller import Decision, Situation, controllers
from control.controllers.heading_hold import Turn
from control.controllers.straight import MM, Leg
from control.model import TURN
from control.registry import Parameters

SHORT_SWEEP = 2.0 / 3.0
"""Share of the gait's sweep that every other leg takes, so that what grows with the sweep can be told from
what does not."""
SLOW = 0.4
"""Share of the rate on the way back, so that a lag in time can be told from a play in angle."""
TURNING_GAIN = 4.0
THERE_WITHIN = math.radians(2.0)
ENDING_RATE = 0.1
"""Towards the end of a sweep that is over already, rad/s."""
SHORTEST = 1e-6
"""Of a sweep that ends as soon as it began, rad."""


class StarParameters(Parameters):
    legs: int = Field(
        default=5, ge=1, le=36, title="Legs", description="Walked out and back.",
        json_schema_extra={"unit": "1"},
    )  # fmt: skip
    leg_mm: float = Field(
        default=20.0, gt=0.0, le=100.0, title="Length of a leg", json_schema_extra={"unit": "mm"}
    )
    rate_deg_s: float = Field(
        default=100.0, gt=0.0, lt=360.0, title="Rate",
        description="How fast to swing on the way out; half as fast on the way back.",
        json_schema_extra={"unit": "°/s"},
    )  # fmt: skip


@controllers.register
class Star:
    """The first leg is along the heading at the start; the robot ends where it began, but for its slip."""

    name = "star"
    title = "Calibration star"
    summary = "Walks legs out and back in directions all round; `pivotrig calibrate gait` learns from it."
    Parameters = StarParameters

    def __init__(self, parameters: StarParameters) -> None:
        self._legs = parameters.legs
        self._distance = parameters.leg_mm * MM
        self._rate = math.radians(parameters.rate_deg_s)
        self._moves: list[Leg | Turn] = []

    def step(self, situation: Situation) -> Decision:
        if not self._moves:
            self._moves = self._plan(situation.pose.heading, situation.gait.sweep)
        decision = self._moves[0].step(situation)
        while situation.may_switch and _is_done(self._moves[0]):
            if len(self._moves) == 1:
                return replace(decision, rate=0.0, finished=True)
            self._moves.pop(0)
            decision = self._moves[0].step(situation)
        return _ended(situation) if _is_done(self._moves[0]) else decision

    def _plan(self, heading: float, sweep: float) -> list[Leg | Turn]:
        moves: list[Leg | Turn] = []
        for number in range(self._legs):
            width = sweep if number % 2 == 0 else SHORT_SWEEP * sweep
            towards = heading + TURN * number / self._legs
            for rate, forward in ((self._rate, 1), (SLOW * self._rate, -1)):
                moves.append(Turn(towards, TURNING_GAIN, THERE_WITHIN, sweep))
                moves.append(Leg(self._distance, rate, forward, width))
        return moves


def _ended(situation: Situation) -> Decision:
    """The sweep under way ends where the body is."""
    turned = situation.turned or SHORTEST
    return Decision(situation.pivot, math.copysign(ENDING_RATE, turned), max(abs(turned), SHORTEST))


def _is_done(move: Leg | Turn) -> bool:
    return move.is_there if isinstance(move, Turn) else move.is_over
