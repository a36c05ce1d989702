"""What another controller would have commanded, asked at each tick of a run and not obeyed.

The run is walked again along its recorded estimates and commands, so that sweeps, pivots and reference go as they
went. Both its own controller, made anew, and the other one are asked in the very situation of each tick.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from control.controllers import Law
from control.controllers.controller import Decision, Situation
from control.model import PIVOT_A, Pivot, Pose, wrap
from control.runs import RunRequest, Selection
from control.snapshot import RigState
from control.walk import Walk
from control.walker import ControllerFault
from server.retrack.changes import RetrackError
from server.retrack.recorded_tick import RecordedTick
from server.retrack.second_look import SecondLook
from server.settings import MM, RigFile
from server.settings_in_si import gait_model

SAME_RATE = 1e-6
"""Rates that are closer are the same: they have been to degrees and back, rad/s."""


@dataclass(frozen=True, slots=True)
class Told:
    """pivot, rate (rad/s): of the field, before the coils' limits hold anything back."""

    pivot: Pivot
    rate: float

    def is_of(self, tick: RecordedTick) -> bool:
        """Whether the rig was told the same at that tick."""
        return self.pivot == tick.command.pivot and self.has_rate_of(tick)

    def has_rate_of(self, tick: RecordedTick) -> bool:
        return abs(self.rate - tick.command.rate) <= SAME_RATE


@dataclass(frozen=True, slots=True)
class Answer:
    """then: what the run's own controller, made anew, would have told the field.  now: what the other one would."""

    then: Told
    now: Told | None


class Aside:
    """The run's own law, which is asked and not obeyed either, and another one beside it.

    pose: what the other one takes for the robot's; None where that is not known.  done: what the rig did.
    """

    def __init__(self, law: Law, other: Law) -> None:
        self._law, self._other = law, other
        self.name = law.name
        self.pose: Pose | None = None
        self.done = Told(PIVOT_A, 0.0)
        self.answer: Answer | None = None

    def step(self, situation: Situation) -> Decision:
        """What the rig did: so the sweeps of the run come out as they did."""
        decision = self._law.step(situation)
        now = None if self.pose is None else self._ask(situation, self.pose)
        self.answer = Answer(_told(decision, situation), now)
        return replace(decision, pivot=self.done.pivot, rate=self.done.rate, finished=False)

    def _ask(self, situation: Situation, pose: Pose) -> Told:
        turned = situation.turned + wrap(pose.heading - situation.pose.heading)
        try:
            decision = self._other.step(replace(situation, pose=pose, turned=turned))
        except Exception as error:  # the boundary to code that anyone may have written
            raise RetrackError(f"controller {self._other.name!r} raised {error!r}") from error
        if not isinstance(decision, Decision) or not math.isfinite(decision.rate):
            raise RetrackError(f"controller {self._other.name!r} returned {decision!r}")
        return _told(decision, situation)


def _told(decision: Decision, situation: Situation) -> Told:
    """What becomes of a decision; a pivot is only taken once a sweep is complete."""
    most = situation.gait.max_rate
    pivot = decision.pivot if situation.may_switch else situation.pivot
    return Told(pivot, max(-most, min(most, decision.rate)))


class Asked:
    """Give it each tick in turn, after the second look at it."""

    def __init__(self, rig: RigFile, request: RunRequest, other: Law) -> None:
        """rig: as it was.  request: what was asked for then."""
        self._rig = rig
        self._request = request
        self._other = other
        self._walk: Walk | None = None
        self._aside: Aside | None = None
        self._before: RecordedTick | None = None

    def change(self, selection: Selection) -> None:
        """The run went on with another choice."""
        if self._walk is None:
            self._request = replace(self._request, selection=selection)
        elif selection != self._walk.request.selection:
            self._walk.change(selection)

    def tick(self, tick: RecordedTick, look: SecondLook, pose: Pose | None) -> Answer | None:
        """The answers at this tick; None while nobody is asked. pose: what the other one is shown."""
        before, self._before = self._before, tick
        if before is not None:
            look.field.aim(before.command.pivot, before.command.tilt, before.command.heading_goal)
        if tick.rig != RigState.RUNNING or tick.pose is None or tick.elapsed is None:
            return None
        if self._walk is None:
            self._walk = self._begun(tick.pose, look)
        elif before is not None and before.rig == RigState.HELD and before.pose is not None:
            self._walk.walker.resume(before.pose.heading)
        elif before is not None and _began_sweep(before, tick, self._walk.walker.sweep.pivot):
            self._walk.walker.resume(tick.pose.heading)
        return self._step(self._walk, tick, before, look, pose)

    def _begun(self, at: Pose, look: SecondLook) -> Walk:
        length = self._rig.robot.length_mm * MM
        walk = Walk("", self._request, length, look.field.pivot, at)
        walk.workspace = 0.5 * self._rig.limits.workspace_mm * MM
        walk.gait_model = gait_model(self._rig)
        walk.put_controllers_into(self._beside)
        return walk

    def _beside(self, law: Law) -> Law:
        self._aside = Aside(law, self._other)
        return self._aside

    def _step(
        self, walk: Walk, tick: RecordedTick, before: RecordedTick | None, look: SecondLook, pose: Pose | None
    ) -> Answer | None:
        if self._aside is None or tick.pose is None or not look.field.is_ready:
            return None
        gap = (tick.elapsed or 0.0) if before is None else tick.time - before.time
        self._aside.pose = pose
        self._aside.done, self._aside.answer = Told(tick.command.pivot, tick.command.rate), None
        try:
            walk.step(tick.time, gap, tick.pose, look.field, look.perception.backlash.lead)
        except (ControllerFault, ValueError) as error:
            raise RetrackError(f"the run cannot be walked through again: {error}") from error
        return self._aside.answer


def _began_sweep(before: RecordedTick, tick: RecordedTick, pivot: Pivot) -> bool:
    """The rig surely took its next sweep at this tick, whatever the account of the walk that is made anew says.

    That may be a tick late or early, as the heading just before the run's first tick is not recorded.
    """
    return tick.command.pivot != pivot or tick.command.rate * before.command.rate < 0.0
