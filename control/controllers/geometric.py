"""The geometric controller, "Gb" (paper, section 4, Algorithm 2)."""

from __future__ import annotations

from pydantic import Field

from control.controllers.controller import Decision, Situation, controllers
from control.model import PIVOT_A, PIVOT_B, Pivot, pivot_point
from control.registry import Parameters

PER_CM_SECOND = 100.0
"""1/(cm s) in 1/(m s)."""


class GeometricParameters(Parameters):
    gain: float = Field(
        default=3.0,
        gt=0.0,
        le=100.0,
        title="Gain k",
        description="Swing rate per distance from the reference: the rate is k times the distance.",
        json_schema_extra={"unit": "1/(cm·s)"},
    )


@controllers.register
class Geometric:
    """Stand on the pivot nearest to the desired point and turn in proportion to the distance from it."""

    name = "geometric"
    title = "Geometric"
    summary = "Stands on the pivot nearest to the reference and swings in proportion to the error."
    Parameters = GeometricParameters

    def __init__(self, parameters: GeometricParameters) -> None:
        self._gain = parameters.gain * PER_CM_SECOND

    def step(self, situation: Situation) -> Decision:
        """sigma = sign(d_B - d_A), chosen when a sweep is complete; omega = k sigma e_n."""
        pivot = self._nearest(situation) if situation.may_switch else situation.pivot
        error = situation.pose.distance_to(*situation.reference)
        return Decision(pivot, self._gain * pivot * error)

    @staticmethod
    def _nearest(situation: Situation) -> Pivot:
        distance_a, distance_b = (_distance(situation, pivot) for pivot in (PIVOT_A, PIVOT_B))
        if distance_a == distance_b:
            return situation.pivot
        return PIVOT_A if distance_a < distance_b else PIVOT_B


def _distance(situation: Situation, pivot: Pivot) -> float:
    x, y = pivot_point(situation.pose, pivot, situation.length)
    desired_x, desired_y = situation.reference
    return ((x - desired_x) ** 2 + (y - desired_y) ** 2) ** 0.5
