"""Walking on the rig: from the controller's decision to the pivot, rate and heading goal of the field.

The body lags behind the field, so the field's goal is the body's goal plus the identified lead; where the
body still falls short once the field stands still, the field goes on by what is missing. A sweep is complete
when the body, by the estimate, has made it; a body that does not come is given up after a while.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from control.controllers.controller import Decision, Law, Situation
from control.gait import Gait, Sweep
from control.gait_model import GaitModel
from control.model import TURN, Pivot, Pose
from control.trajectories.trajectory import Path

COMPLETE_WITHIN = math.radians(0.3)
"""A sweep is complete when the estimate is this close to its end: the noise of one camera measurement."""
SETTLE = 0.05
"""The field has stood still this long before a shortfall of the body is believed, s: the camera's latency."""
STUCK_AFTER = 6
"""Times the field goes on after a body that stays behind, before its sweep counts as ended where it is."""


class ControllerFault(Exception):
    """A controller raised, or returned what no rig can do."""


@dataclass(frozen=True, slots=True)
class Moment:
    """now: s.  field_settled: the field stands still on its goal.  lead: of the field, by direction, rad.

    workspace, slip: as in `Situation`.
    """

    now: float
    pose: Pose
    reference: tuple[float, float]
    reference_time: float
    trajectory: Path
    field_settled: bool
    lead: Callable[[float], float]
    workspace: float | None = None
    slip: GaitModel | None = None


@dataclass(frozen=True, slots=True)
class Stride:
    """What the field should do until the next tick: rate in rad/s, goal of the field's heading in rad."""

    pivot: Pivot
    rate: float
    heading_goal: float


class Walker:
    """One walk of one controller on the rig."""

    def __init__(self, controller: Law, gait: Gait, length: float, pivot: Pivot, heading: float) -> None:
        self.controller = controller
        self.gait = gait
        self.sweep = Sweep(gait.sweep, pivot, heading)
        self.stuck = 0
        self.is_finished = False
        self.is_deciding = False
        """The controller has been asked and has not answered yet; another thread may look."""
        self._length = length
        self._may_switch = True
        self._direction = 1.0
        self._extension = 0.0
        self._extensions = 0
        self._settled_since = math.inf

    def change(self, controller: Law, gait: Gait) -> None:
        """Another law or gait from the next tick on; the sweep that is under way takes the new angle."""
        self.controller = controller
        self.gait = gait
        self.sweep.angle = gait.sweep

    def resume(self, heading: float) -> None:
        """Go on after a hold: the sweep starts anew at the body's heading."""
        self.sweep.start = heading
        self._begin_sweep()

    def step(self, moment: Moment) -> Stride:
        """The next stride; raises `ControllerFault`."""
        if not self._may_switch and self._is_complete(moment):
            self.sweep.complete(moment.pose.heading)
            self._begin_sweep()
        decision = self._decide(moment)
        self.is_finished = decision.finished
        if self._may_switch:
            self.sweep.choose(decision.pivot)
            self._may_switch = decision.rate == 0.0
        self.sweep.angle = self.gait.sweep if decision.sweep is None else decision.sweep
        rate = max(-self.gait.max_rate, min(self.gait.max_rate, decision.rate))
        self.sweep.turning(rate)
        self._direction = math.copysign(1.0, rate) if rate else self._direction
        lead = moment.lead(self._direction) + self._direction * self._extension
        return Stride(self.sweep.pivot, rate, self.sweep.goal(self._direction) + lead)

    def _begin_sweep(self) -> None:
        self._may_switch = True
        self._extension = 0.0
        self._extensions = 0
        self._settled_since = math.inf

    def _is_complete(self, moment: Moment) -> bool:
        missing = self.sweep.remaining(moment.pose.heading, self._direction)
        if missing <= COMPLETE_WITHIN:
            return True
        if not moment.field_settled:
            self._settled_since = math.inf
            return False
        self._settled_since = min(self._settled_since, moment.now)
        if moment.now - self._settled_since < SETTLE:
            return False
        return self._extend(missing)

    def _extend(self, missing: float) -> bool:
        """Let the field go on by what the body misses; True when that has been tried often enough."""
        self._settled_since = math.inf
        self._extension += missing
        self._extensions += 1
        is_stuck = self._extensions > STUCK_AFTER
        self.stuck += is_stuck
        return is_stuck

    def _decide(self, moment: Moment) -> Decision:
        situation = Situation(
            pose=moment.pose,
            pivot=self.sweep.pivot,
            may_switch=self._may_switch,
            turned=self.sweep.turned(moment.pose.heading),
            reference=moment.reference,
            trajectory=moment.trajectory,
            reference_time=moment.reference_time,
            gait=self.gait,
            length=self._length,
            workspace=moment.workspace,
            slip=moment.slip,
        )
        self.is_deciding = True
        try:
            decision = self.controller.step(situation)
        except Exception as error:  # the boundary to code that anyone may have written
            raise ControllerFault(f"controller {self.controller.name!r} raised {error!r}") from error
        finally:
            self.is_deciding = False
        if (
            not isinstance(decision, Decision)
            or decision.pivot not in (1, -1)
            or not _is_finite(decision.rate)
            or not _is_sweep(decision.sweep)
        ):
            raise ControllerFault(f"controller {self.controller.name!r} returned {decision!r}")
        return decision


def _is_finite(rate: object) -> bool:
    return isinstance(rate, int | float) and math.isfinite(rate)


def _is_sweep(sweep: object) -> bool:
    return sweep is None or (isinstance(sweep, int | float) and 0.0 < sweep <= TURN)
