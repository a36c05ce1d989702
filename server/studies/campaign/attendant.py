"""Who looks after a rig that walks unattended: when a campaign goes on by itself, and when it waits for a person.

The written policy (SAFETY.md, "Campaigns"): after a *hold* it gives the run up and resumes once the cause has gone;
after a *disarm* or a *fault* it waits for a person to reset and arm the rig; whoever stops the rig stops the campaign.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Literal, TypeVar

from control.coil_heat import OFF_AT
from control.gait import Gait
from control.loop import PAUSED, ControlLoop
from control.model import Tracking
from control.safety import Refused
from control.snapshot import RigState, Snapshot
from server.studies.campaign.operator import Operator
from server.studies.campaign.rules import MINUTE, Rules

T = TypeVar("T")

RETRY = 0.5
"""What was refused is asked for again so often, s."""
CALM = 1.0
"""The robot is seen for this long, s, on a rig whose state does not change, before its coils are switched on: whoever
puts it back by hand has drawn the hand away."""
COOLING = "the coils cool"
"""Why a campaign's rig is held that is not held by a fault."""


class Stopped(Exception):
    """The campaign ends here, and can be resumed. state: of the study."""

    def __init__(self, reason: str, state: Literal["stopped", "interrupted"] = "stopped") -> None:
        super().__init__(reason)
        self.state: Literal["stopped", "interrupted"] = state


class Interrupted(Exception):
    """What went on did not come to its end; the text says why."""


class Attendant:
    """say: is told in words what the campaign does or waits for."""

    def __init__(self, operator: Operator, rules: Rules, say: Callable[[str], None]) -> None:
        self.say = say
        self._operator = operator
        self._rules = rules
        self._may_arm = operator.may_arm
        self._order: Stopped | None = None
        self._was: RigState | None = None
        self._asked_at = self._calm_since = self._disk_refused_at = -math.inf

    def stop(self, reason: str, *, is_end: bool = False) -> None:
        """From any thread and from signal handlers: what goes on ends at the next tick. The first order counts."""
        self._order = self._order or Stopped(reason, "interrupted" if is_end else "stopped")

    def tick(self) -> Snapshot:
        """The next tick; raises `Stopped` once that was ordered."""
        snapshot = self._operator.tick()
        self.require_going()
        if snapshot.rig is not self._was or snapshot.tracking is not Tracking.LOCKED:
            self._calm_since = self._operator.now
        self._was = snapshot.rig
        return snapshot

    def require_going(self) -> None:
        """Raises `Stopped` once that was ordered; from any thread."""
        if self._order is not None:
            raise self._order

    def do(self, act: Callable[[ControlLoop], T]) -> T:
        """Between two ticks, and not once the campaign has been stopped: an order that comes while this is on its way
        to the rig counts before it. Raises `Stopped`, and what `act` raises."""

        def unless_stopped(loop: ControlLoop) -> T:
            self.require_going()
            return act(loop)

        return self._operator.do(unless_stopped)

    # Until a run may begin -----------------------------------------------------------------------

    def until_fit(self, gait: Gait) -> Snapshot:
        """Until the rig is armed, sees its robot and is cool; raises `Stopped` where that takes too long.

        gait: to arm with, where the campaign may arm.
        """
        give_up = self._operator.now + self._rules.patience
        while True:
            snapshot = self.tick()
            obstacle = self._further(snapshot, gait)
            if obstacle is None:
                self._may_arm = False
                return snapshot
            if not obstacle:
                give_up = self._operator.now + self._rules.patience
            elif self._operator.now > give_up:
                raise Stopped(f"waited for {self._rules.patience / MINUTE:g} min: {obstacle}")

    def _is_fit(self, snapshot: Snapshot) -> bool:
        is_armed = snapshot.rig is RigState.ARMED
        return is_armed and self._is_cool(snapshot) and not self._operator.do(lambda loop: loop.obstacle)

    def _is_cool(self, snapshot: Snapshot) -> bool:
        return all(heat <= self._rules.cool_to for heat in snapshot.coil_heat)

    def _further(self, snapshot: Snapshot, gait: Gait) -> str | None:
        """Do what may be done towards a rig that is fit; what bars the way, "" for what only takes its time, None
        where a run may begin."""
        if self._is_fit(snapshot):
            return self._disk_trouble()
        match snapshot.rig:
            case RigState.FAULT:
                self._may_arm = False
                return self._need_person(f"reset and arm the rig ({snapshot.reason})")
            case RigState.DISARMED if not self._may_arm:
                return self._need_person(f"arm the rig ({snapshot.reason})")
            case _ if not self._is_cool(snapshot):
                return self._cool(snapshot)
            case RigState.DISARMED | RigState.HELD if not self._is_calm:
                return self._told(f"waiting: {snapshot.tracking_reason or snapshot.reason}")
            case RigState.DISARMED:
                return self._try(lambda loop: self._arm(loop, gait), "getting ready")
            case RigState.HELD:
                return self._try(lambda loop: loop.resume(), "held")
            case _:
                return self._told(f"waiting: {snapshot.tracking_reason or 'something bars the way'}")

    @property
    def _is_calm(self) -> bool:
        return self._operator.now - self._calm_since >= CALM

    def _arm(self, loop: ControlLoop, gait: Gait) -> None:
        """Once: what a person has agreed to holds for no second time."""
        loop.arm(gait, consent=True)
        self._may_arm = False

    def _disk_trouble(self) -> str | None:
        """Why a run could not be recorded, None where it could."""
        if self._operator.now - self._disk_refused_at < RETRY:
            return "waiting for the disk"
        try:
            self._operator.check_disk()
        except Refused as refusal:
            self._disk_refused_at = self._operator.now
            return self._told(f"waiting: {refusal}")
        return None

    def _told(self, words: str) -> str:
        self.say(words)
        return words

    def _need_person(self, what: str) -> str:
        if not self._operator.is_attended:
            raise Stopped(f"a person must {what}, and then resume the study")
        return self._told(f"waiting for a person: {what}")

    def _cool(self, snapshot: Snapshot) -> str:
        """Rest with the coils off; that takes its time, and is no reason to give up."""
        hottest = max(snapshot.coil_heat, default=OFF_AT)
        at, to = math.ceil(100.0 * hottest), math.floor(100.0 * self._rules.cool_to)
        self.say(f"waiting for the coils to cool: {at} % → {to} %")
        if snapshot.rig is RigState.ARMED:
            self._try(lambda loop: loop.rest(COOLING), "cooling")
        return ""

    def _try(self, act: Callable[[ControlLoop], None], doing: str) -> str:
        """What the rig refuses is asked for again after a while."""
        if self._operator.now - self._asked_at < RETRY:
            return doing
        self._asked_at = self._operator.now
        try:
            self.do(act)
        except Refused as refusal:
            return self._told(f"{doing}: {refusal}")
        return doing

    # While the robot walks -----------------------------------------------------------------------

    def follow(self) -> Snapshot:
        """To the end of the walk that is on; raises `Interrupted` when something holds it, which ends it."""
        while True:
            snapshot = self.tick()
            if snapshot.run is None:
                return snapshot
            if snapshot.rig is RigState.HELD and snapshot.reason != PAUSED:
                self.abandon(snapshot.reason)
                raise Interrupted(snapshot.reason)

    def abandon(self, reason: str) -> None:
        """End the walk that is on, if it is on still."""
        try:
            self._operator.do(lambda loop: loop.abandon_run(reason))
        except Refused:  # it has come to its end meanwhile
            return

    def rest(self, duration: float) -> Snapshot:
        """Let the robot come to rest for so long, s; raises `Interrupted` where the rig does not stay armed."""
        until = self._operator.now + duration
        while True:
            snapshot = self.tick()
            if snapshot.rig is not RigState.ARMED:
                raise Interrupted(snapshot.reason)
            if self._operator.now >= until:
                return snapshot

    def until(self, condition: Callable[[], bool], within: float) -> None:
        """Let the rig go on until the condition holds, though no longer than so long, s."""
        give_up = self._operator.now + within
        while not condition() and self._operator.now < give_up:
            self.tick()

    def leave(self) -> None:
        """Nobody walks any more, and the coils are off."""
        reason = "the study is over" if self._order is None else str(self._order)
        try:
            self.abandon(reason)
            self._operator.do(lambda loop: _put_down(loop, reason))
            self._operator.tick()
        except Refused:  # the rig hangs; it has been stopped from outside
            return


def _put_down(loop: ControlLoop, reason: str) -> None:
    if loop.state is not RigState.FAULT:
        loop.disarm(reason)
