"""Heading hold: turn to a heading and keep it, at the place where the robot stands."""

from __future__ import annotations

import math

from pydantic import Field

from control.controllers.controller import Decision, Situation, controllers
from control.model import PIVOT_A, PIVOT_B, Pivot, Pose, swing, wrap
from control.registry import Parameters


class HoldParameters(Parameters):
    heading_deg: float = Field(
        default=90.0, ge=-360.0, le=360.0, title="Heading", description="Direction of walking to keep.",
        json_schema_extra={"unit": "°", "live": True, "step": 5},
    )  # fmt: skip
    gain: float = Field(
        default=2.0, gt=0.0, le=20.0, title="Gain", description="Swing rate per heading error.",
        json_schema_extra={"unit": "1/s", "live": True, "step": 0.1},
    )  # fmt: skip
    tolerance_deg: float = Field(
        default=0.5, ge=0.0, le=20.0, title="Tolerance",
        description="A smaller heading error is left alone.",
        json_schema_extra={"unit": "°", "live": True, "step": 0.1},
    )  # fmt: skip


class Turn:
    """Turns to `heading` (rad): omega = gain * error, one sweep after the other on whichever pivot keeps the
    centre nearest to the place where the turn began.

    gain: 1/s.  tolerance: rad.  sweep: rad, None for the gait's.
    """

    def __init__(self, heading: float, gain: float, tolerance: float, sweep: float | None = None) -> None:
        self.is_there = False
        self._heading = heading
        self._gain = gain
        self._tolerance = tolerance
        self._sweep = sweep
        self._place: Pose | None = None

    def step(self, situation: Situation) -> Decision:
        place = self._place = self._place or situation.pose
        error = wrap(self._heading - situation.pose.heading)
        self.is_there = abs(error) <= self._tolerance
        if self.is_there:
            return Decision(situation.pivot, 0.0, self._sweep)
        pivot = self._nearest(place, situation, error) if situation.may_switch else situation.pivot
        return Decision(pivot, self._gain * error, self._sweep)

    def _nearest(self, place: Pose, situation: Situation, error: float) -> Pivot:
        """The pivot about which the next sweep ends nearest to the place; a tie keeps the active one."""
        whole = situation.gait.sweep if self._sweep is None else self._sweep
        angle = max(-whole, min(whole, error))

        def distance(pivot: Pivot) -> float:
            return swing(situation.pose, pivot, angle, situation.length).distance_to(place.x, place.y)

        to_a, to_b = distance(PIVOT_A), distance(PIVOT_B)
        if math.isclose(to_a, to_b):
            return situation.pivot
        return PIVOT_A if to_a < to_b else PIVOT_B


@controllers.register
class Hold:
    """Keeps the heading; the place only in so far as turning on alternate pivots returns to it."""

    name = "hold"
    title = "Heading hold"
    summary = "Turns on the spot to a heading and keeps it."
    Parameters = HoldParameters

    def __init__(self, parameters: HoldParameters) -> None:
        self._turn = Turn(
            math.radians(parameters.heading_deg), parameters.gain, math.radians(parameters.tolerance_deg)
        )

    def step(self, situation: Situation) -> Decision:
        return self._turn.step(situation)
