"""To a pose: walk to a place and end there with a wanted heading, wherever the path is."""

from __future__ import annotations

import cmath
import math

from pydantic import Field

from control.controllers.controller import Decision, Situation, controllers
from control.controllers.planner.slip import Sighting, SlipWatch, SwitchSlip
from control.controllers.to_pose.search import Bounds, ChainSearch, Standing, Step
from control.controllers.to_pose.way import Tolerance, WayToGo
from control.gait import advance_of_sweep
from control.gait_model import GaitModel
from control.model import Pivot, Pose, opposite
from control.registry import Parameters

MM = 1e-3
ANGLES = tuple(math.radians(angle) for angle in (5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0))
"""Sweeps that are made, rad: small ones for the last millimetre; slip is known up to the widest."""
PATIENCE = 60
"""Sweeps that may be made beyond three times those that a straight way takes; then it is given up."""


class ToPoseParameters(Parameters):
    x_mm: float = Field(
        default=0.0, ge=-500.0, le=500.0, title="x", description="Of the place.",
        json_schema_extra={"unit": "mm"},
    )  # fmt: skip
    y_mm: float = Field(
        default=0.0, ge=-500.0, le=500.0, title="y", description="Of the place.",
        json_schema_extra={"unit": "mm"},
    )  # fmt: skip
    heading_deg: float = Field(
        default=90.0, ge=-360.0, le=360.0, title="Heading", description="Direction of walking at the end.",
        json_schema_extra={"unit": "°"},
    )  # fmt: skip
    within_mm: float = Field(
        default=0.5, ge=0.1, le=20.0, title="Place within", description="How near to the place is there.",
        json_schema_extra={"unit": "mm"},
    )  # fmt: skip
    within_deg: float = Field(
        default=3.0, ge=0.5, le=180.0, title="Heading within", description="How near to the heading is there.",
        json_schema_extra={"unit": "°"},
    )  # fmt: skip
    rate_deg_s: float = Field(
        default=90.0, gt=0.0, lt=360.0, title="Rate", description="How fast to swing.",
        json_schema_extra={"unit": "°/s"},
    )  # fmt: skip


@controllers.register
class ToPose:
    """At each completed sweep the chain of sweeps that leads nearest is searched anew, and its first one made.

    The run ends when the robot is there, or stands as near as it can come.
    """

    name = "to_pose"
    title = "To a pose"
    summary = "Walks to a place and ends there with a wanted heading, without looking at the path."
    Parameters = ToPoseParameters

    def __init__(self, parameters: ToPoseParameters) -> None:
        self._goal = complex(parameters.x_mm, parameters.y_mm) * MM
        self._towards = cmath.exp(1j * math.radians(parameters.heading_deg))
        self._tolerance = Tolerance(parameters.within_mm * MM, math.radians(parameters.within_deg))
        self._rate = math.radians(parameters.rate_deg_s)
        self._search: ChainSearch | None = None
        self._watch = SlipWatch(SwitchSlip())
        self._left = 0
        self._step = Step(switches=False, angle=0.0, cost=0.0)
        self._departure: tuple[Pose, Pivot | None] | None = None
        self._turned = 0.0

    def step(self, situation: Situation) -> Decision:
        search = self._search or self._prepare(situation)
        if not situation.may_switch:
            return self._swing(situation.pivot)
        self._arrive(situation)
        step = search.best(self._standing(situation), self._watch.slip, self._bounds(situation))
        if step is None or not self._left:
            return Decision(situation.pivot, 0.0, finished=True)
        self._left -= 1
        self._step = step
        self._departure = situation.pose, situation.pivot if step.switches else None
        return self._swing(opposite(situation.pivot) if step.switches else situation.pivot)

    def _swing(self, pivot: Pivot) -> Decision:
        angle = self._step.angle or ANGLES[0]
        return Decision(pivot, math.copysign(self._rate, angle), abs(angle))

    def _prepare(self, situation: Situation) -> ChainSearch:
        known = situation.slip or GaitModel(situation.length)
        way = WayToGo(known.length, ANGLES[-1], self._tolerance)
        self._watch = SlipWatch(SwitchSlip(known.out, known.forward_base, known.forward_per_sweep))
        distance = abs(self._goal - complex(situation.pose.x, situation.pose.y))
        self._left = PATIENCE + math.ceil(3.0 * distance / advance_of_sweep(ANGLES[-1], known.length))
        self._length = known.length
        self._search = ChainSearch(way, ANGLES)
        return self._search

    def _arrive(self, situation: Situation) -> None:
        """A sweep has ended here: learn from it how this robot slips."""
        if self._departure is None:
            return
        (before, left), after = self._departure, situation.pose
        turn = after.heading - before.heading
        if left is None:
            self._turned += turn
            return
        self._watch.see(Sighting(before, left, self._turned, after), self._length)
        self._turned = turn

    def _standing(self, situation: Situation) -> Standing:
        """The robot, seen from the wanted pose."""
        pose, back = situation.pose, self._towards.conjugate()
        return Standing(
            place=(complex(pose.x, pose.y) - self._goal) * back,
            facing=cmath.exp(1j * pose.heading) * back,
            pivot=float(situation.pivot),
            turned=self._turned,
        )

    def _bounds(self, situation: Situation) -> Bounds:
        edge = math.inf if situation.workspace is None else situation.workspace
        return Bounds(self._goal, self._towards, edge)
