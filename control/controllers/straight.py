"""Straight-line walking (paper, section 3, Algorithm 1): half a sweep, then full ones on alternating pivots."""

from __future__ import annotations

import math
from dataclasses import replace

from pydantic import Field

from control.controllers.controller import Decision, Situation, controllers
from control.model import Pose, opposite
from control.registry import Parameters

MM = 1e-3
ARRIVED_WITHIN = 1e-9
"""A distance that is short by rounding alone has been walked, m."""


class StraightParameters(Parameters):
    distance_mm: float = Field(
        default=60.0, gt=0.0, le=500.0, title="Distance", description="Stop after this way.",
        json_schema_extra={"unit": "mm"},
    )  # fmt: skip
    rate_deg_s: float = Field(
        default=60.0, gt=0.0, lt=360.0, title="Rate", description="How fast to swing.",
        json_schema_extra={"unit": "°/s"},
    )  # fmt: skip
    backwards: bool = Field(default=False, title="Backwards", description="Walk against the heading.")


class Leg:
    """One straight walk along the heading that the robot has at its first step.

    distance: m.  rate: rad/s.  forward: +1 along the heading, -1 against it.  sweep: rad, None for the gait's.
    Each step is one switch of the pivot, the first one too; the walk ends with the sweep that completes it.
    """

    def __init__(self, distance: float, rate: float, forward: int = 1, sweep: float | None = None) -> None:
        self.steps = 0
        self.is_over = False
        self._distance = distance
        self._rate = rate
        self._forward = forward
        self._sweep = sweep
        self._start: Pose | None = None

    def step(self, situation: Situation) -> Decision:
        """sigma alternates, and omega has its sign (times `forward`), so that each arc leads the same way."""
        if not situation.may_switch:
            return self._swing(situation)
        start = self._start = self._start or situation.pose
        if self._walked(start, situation.pose) >= self._distance - ARRIVED_WITHIN:
            self.is_over = True
            return Decision(situation.pivot, 0.0)
        self.steps += 1
        return self._swing(situation)

    def _walked(self, start: Pose, now: Pose) -> float:
        """Way along the first heading, m."""
        dx, dy = now.x - start.x, now.y - start.y
        return self._forward * (dx * math.cos(start.heading) + dy * math.sin(start.heading))

    def _swing(self, situation: Situation) -> Decision:
        pivot = opposite(situation.pivot) if situation.may_switch else situation.pivot
        whole = situation.gait.sweep if self._sweep is None else self._sweep
        sweep = 0.5 * whole if self.steps == 1 else whole
        return Decision(pivot, self._forward * pivot * self._rate, sweep)


@controllers.register
class Straight:
    """Algorithm 1 as a controller; it looks at no reference and stops after its distance."""

    name = "straight"
    title = "Straight line"
    summary = "Walks straight on along its heading for a given distance, without looking at the path."
    Parameters = StraightParameters

    def __init__(self, parameters: StraightParameters) -> None:
        self.leg = Leg(
            distance=parameters.distance_mm * MM,
            rate=math.radians(parameters.rate_deg_s),
            forward=-1 if parameters.backwards else 1,
        )

    def step(self, situation: Situation) -> Decision:
        decision = self.leg.step(situation)
        return replace(decision, finished=self.leg.is_over)
