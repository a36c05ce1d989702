"""A controller of one's own: pivotrig run --plugin spiral_chaser.py --controller spiral_chaser"""

import math

from pydantic import Field

from control.controllers import Decision, Situation, controllers
from control.model import PIVOT_A, PIVOT_B, pivot_point
from control.registry import Parameters


class SpiralParameters(Parameters):
    gain: float = Field(default=4.0, gt=0.0, le=50.0, title="Gain", json_schema_extra={"unit": "1/(cm·s)"})
    lead_s: float = Field(default=0.5, ge=0.0, le=10.0, title="Lead", json_schema_extra={"unit": "s"})


@controllers.register
class SpiralChaser:
    name, title = "spiral_chaser", "Spiral chaser"
    summary = "Swings about the pivot nearest to where the reference will be, the faster the farther that is."
    Parameters = SpiralParameters

    def __init__(self, parameters: SpiralParameters) -> None:
        self.parameters = parameters

    def step(self, now: Situation) -> Decision:
        x, y = now.trajectory.point(now.reference_time + self.parameters.lead_s)
        a, b = (math.dist(pivot_point(now.pose, pivot, now.length), (x, y)) for pivot in (PIVOT_A, PIVOT_B))
        pivot = (PIVOT_A if a < b else PIVOT_B) if now.may_switch else now.pivot
        return Decision(pivot, pivot * self.parameters.gain * 100.0 * now.pose.distance_to(x, y))
