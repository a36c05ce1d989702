"""A controller of one's own: pivotrig run --plugin spiral_chaser.py --controller spiral_chaser"""

from pydantic import Field

from control.controllers import Decision, Situation, controllers
from control.model import PIVOT_A, PIVOT_B, pivot_point
from control.registry import Parameters


class SpiralParameters(Parameters):
    rate_deg_s: float = Field(default=80.0, gt=0.0, lt=360.0, title="Rate", json_schema_extra={"unit": "°/s"})
    lead_s: float = Field(default=1.0, ge=0.0, le=10.0, title="Lead", json_schema_extra={"unit": "s"})


@controllers.register
class SpiralChaser:
    name = "spiral_chaser"
    title = "Spiral chaser"
    summary = "Stands on the pivot nearest to where the reference will be, and always swings as fast as told."
    Parameters = SpiralParameters

    def __init__(self, parameters: SpiralParameters) -> None:
        self.parameters = parameters

    def step(self, now: Situation) -> Decision:
        x, y = now.trajectory.point(now.reference_time + self.parameters.lead_s)
        a, b = (pivot_point(now.pose, pivot, now.length) for pivot in (PIVOT_A, PIVOT_B))
        nearer_a = (a[0] - x) ** 2 + (a[1] - y) ** 2 < (b[0] - x) ** 2 + (b[1] - y) ** 2
        pivot = (PIVOT_A if nearer_a else PIVOT_B) if now.may_switch else now.pivot
        return Decision(pivot, pivot * self.parameters.rate_deg_s * 3.1416 / 180.0)
