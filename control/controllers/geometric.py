"""The geometric controller, "Gb" (paper, section 4, Algorithm 2)."""

from __future__ import annotations

from pydantic import Field

from control.controllers.controller import Decision, Situation, controllers
from control.model import PIVOT_A, PIVOT_B, Pivot, Place, distance, pivot_point
from control.registry import Parameters

Point = tuple[float, float]
PER_CM_SECOND = 100.0
"""1/(cm s) in 1/(m s)."""


class GeometricParameters(Parameters):
    gain: float = Field(
        default=3.0,
        gt=0.0,
        le=100.0,
        title="Gain k",
        description="Swing rate per distance from the reference: the rate is k times the distance.",
        json_schema_extra={"unit": "1/(cm·s)", "live": True, "step": 0.1},
    )


@controllers.register
class Geometric:
    """Stand on the pivot nearest to the desired point and turn in proportion to the distance from it."""

    name = "geometric"
    title = "Geometric"
    summary = "Stands on the pivot nearest to the reference and swings in proportion to the error."
    Parameters = GeometricParameters

    def __init__(self, parameters: GeometricParameters) -> None:
        self.gain = parameters.gain * PER_CM_SECOND
        """k, 1/(m s)."""

    def step(self, situation: Situation) -> Decision:
        """sigma = sign(d_B - d_A), chosen when a sweep is complete; omega = k sigma e_n."""
        pose, reference, pivot = situation.pose, situation.reference, situation.pivot
        if situation.may_switch:
            pivot = nearest_pivot(pose, reference, pivot, situation.length)
        return Decision(pivot, swing_rate(self.gain, pivot, pose, reference))


def nearest_pivot(pose: Place, desired: Point, pivot: Pivot, length: float) -> Pivot:
    """sigma = sign(d_B - d_A); `pivot`, the one in use, when both are as near. desired: m.  length: m."""
    distance_a = distance(*pivot_point(pose, PIVOT_A, length), *desired)
    distance_b = distance(*pivot_point(pose, PIVOT_B, length), *desired)
    if distance_a == distance_b:
        return pivot
    return PIVOT_A if distance_a < distance_b else PIVOT_B


def swing_rate(gain: float, pivot: Pivot, pose: Place, desired: Point) -> float:
    """omega = k sigma e_n, rad/s. gain: 1/(m s).  desired: m."""
    return gain * pivot * distance(pose.x, pose.y, desired[0], desired[1])
