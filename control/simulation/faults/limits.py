"""What can come to the edge of what the rig allows."""

from __future__ import annotations

import math

from control.coil_heat import CoilHeat
from control.model import Pose
from control.registry import Parameters
from control.simulation.faults.board import AXES, OneCoil
from control.simulation.faults.kind import Family, FaultKind, quantity
from control.simulation.faults.points import FaultPoints

MM = 1e-3


class Place(Parameters):
    x_mm: float = quantity(0.0, "mm", -75.0, 75.0, "Along x")
    y_mm: float = quantity(-69.0, "mm", -75.0, 75.0, "Along y")
    heading_deg: float = quantity(90.0, "°", -360.0, 360.0, "Heading")

    def to_si(self) -> Pose:
        return Pose(self.x_mm * MM, self.y_mm * MM, math.radians(self.heading_deg))


class Heat(OneCoil):
    heat_percent: float = quantity(95.0, "%", 0.0, 200.0, "Of the heat at which the coils are switched off")


def _heat(points: FaultPoints, coil: int, share: float) -> None:
    heat = points.coils.coil_heat
    one, two, three = (share if place == coil else other for place, other in enumerate(heat.shares))
    points.coils.coil_heat = CoilHeat((one, two, three), heat.is_too_hot)


KINDS = (
    FaultKind(
        "robot_put", 20, Family.LIMITS, "Robot put elsewhere",
        "Somebody takes the robot and puts it down somewhere else.",
        "when the robot is back in the workspace",
        lambda points, place: points.robot.nudge(place.to_si()), parameters=Place, happens_once=True,
    ),
    FaultKind(
        "coil_hot", 22, Family.LIMITS, "Coil hot",
        "One pair of coils is as hot as after long work.",
        "as the coils cool down",
        lambda points, hot: _heat(points, AXES.index(hot.coil), hot.heat_percent * 0.01),
        parameters=Heat, happens_once=True,
    ),
)  # fmt: skip
