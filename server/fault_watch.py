"""What a simulated rig does about the faults that are put into it, for comparison with what it promises."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from enum import StrEnum
from typing import TYPE_CHECKING

from control.safety import ENERGISED
from control.simulation.faults.promises import PROMISES, Promise
from control.snapshot import RigState, Snapshot, Vector

if TYPE_CHECKING:
    from control.news import Announcement
    from server.rig_life import RigLife
    from server.settings import RigFile

GONE = 0.05
"""Share of its limit under which a current counts as gone (faults.md, I2)."""
LOOK = 6.0
"""So long after a fault, s, everything that is promised has happened: the slowest, a controller that hangs, takes 3."""
CARRIED_ON = 2.0
"""A rig that promises to carry on, and does so for this long, s, has kept its promise."""
ALLOWANCE = 0.06
"""Seconds that a rig in real time may take longer than the promise, which is tried out in simulated time: three
frames, which a busy computer is late by."""
TIME_CONSTANTS = 3
"""Of a coil, L/R: after so many of them without drive its current is gone."""


class Verdict(StrEnum):
    """`open`: the promise is for another case, of a robot that walks, or somebody has stopped the rig meanwhile."""

    WATCHING = "watching"
    KEPT = "kept"
    BROKEN = "broken"
    OPEN = "open"
    AT_REST = "at_rest"


@dataclass(slots=True)
class Reaction:
    """Of a rig to one fault. since: rig time, s.  was: its state before.  is_usual: the promise is for this fault.

    decay: of the coils' current without drive, s.
    became: the state it went to first, None while it has not left the one it was in.  reason: of that state.
    changed: when, zero: when no current flowed any more; s after the fault.  is_over: nothing more is looked for.
    """

    name: str
    since: float
    was: RigState
    is_usual: bool
    decay: float
    became: RigState | None = None
    reason: str = ""
    changed: float | None = None
    zero: float | None = None
    is_over: bool = False

    @property
    def promise(self) -> Promise:
        return PROMISES[self.name]

    @property
    def due(self) -> float | None:
        """The current is gone within this, s; None where the robot walks on."""
        return None if self.promise.zero is None else self.promise.zero * 1e-3 + self.decay

    def judge(self, cause: Announcement | None, now: float) -> Verdict:
        """cause: the line of the log that tells of it, if there is one.  now: rig time, s."""
        if self.was not in ENERGISED:
            return Verdict.AT_REST
        if self.became is None or self.became in ENERGISED:
            return self._carrying_on(now)
        code = "" if cause is None else cause.code
        promise = self.promise
        if self.zero is None and not self.is_over:
            return Verdict.WATCHING
        if code not in {code for _, code in promise.outcomes} and self.became is not promise.met:
            return self._for_another_reason()
        noticed_by = None if promise.noticed is None else promise.noticed * 1e-3
        in_time = is_within(self.noticed(cause), noticed_by) and is_within(self.zero, self.due)
        return Verdict.KEPT if in_time and self.became in promise.states else self._otherwise()

    def noticed(self, cause: Announcement | None) -> float | None:
        """How long after the fault the rig said what is wrong, s."""
        return self.changed if cause is None else max(0.0, cause.time - self.since)

    def _carrying_on(self, now: float) -> Verdict:
        elapsed = now - self.since
        if RigState.RUNNING in self.promise.states:
            return Verdict.KEPT if elapsed > CARRIED_ON else Verdict.WATCHING
        due = (self.promise.noticed or 0) * 1e-3 + ALLOWANCE
        return Verdict.WATCHING if elapsed < max(due, CARRIED_ON) else self._otherwise()

    def _for_another_reason(self) -> Verdict:
        """A busy computer, or a hand on STOP, was quicker than the fault; where nothing should stop, that was it."""
        return self._otherwise() if RigState.RUNNING in self.promise.states else Verdict.OPEN

    def _otherwise(self) -> Verdict:
        """Not what was promised; the promise itself is for a robot that walks, and for the usual fault."""
        return Verdict.BROKEN if self.was is RigState.RUNNING and self.is_usual else Verdict.OPEN


def is_within(taken: float | None, promised: float | None) -> bool:
    """Both in s; None promised: nothing that could be late."""
    return promised is None or (taken is not None and taken <= promised + ALLOWANCE)


def decay_of(settings: RigFile) -> float:
    """How long the slowest coil's current takes to go without drive, s."""
    coils = settings.coils.x, settings.coils.y, settings.coils.z
    return TIME_CONSTANTS * max(coil.inductance_mH * 1e-3 / coil.resistance_ohm for coil in coils)


def cause_of(reaction: Reaction, events: Iterable[Announcement]) -> Announcement | None:
    """The first line of the log, oldest first, that tells of an error after the fault."""
    later = (line for line in events if line.time >= reaction.since and line.severity == "error")
    return next(later, None)


@dataclass(slots=True)
class _Watch:
    """One reaction while it is looked for. milliseconds: of the board since the fault."""

    reaction: Reaction
    limits: Vector
    milliseconds: int = 0
    ends: ExitStack = field(default_factory=ExitStack)

    def hear(self, currents: Sequence[Vector]) -> None:
        """The board's currents, A."""
        if self.reaction.zero is None:
            for number, each in enumerate(currents, self.milliseconds + 1):
                if all(abs(current) < GONE * limit for current, limit in zip(each, self.limits, strict=True)):
                    self.reaction.zero = number * 1e-3
                    break
        self.milliseconds += len(currents)

    def see(self, snapshot: Snapshot) -> None:
        reaction, elapsed = self.reaction, snapshot.time - self.reaction.since
        if reaction.became is None and snapshot.rig is not reaction.was:
            reaction.became, reaction.reason, reaction.changed = (
                snapshot.rig,
                snapshot.reason,
                max(0.0, elapsed),
            )
        if elapsed > LOOK or (reaction.changed is not None and reaction.zero is not None):
            self.end()

    def end(self) -> None:
        self.reaction.is_over = True
        self.ends.close()


class FaultWatch:
    """The newest reaction to each kind of fault. `begin` belongs to the rig's thread, just before the fault."""

    def __init__(self, rig: RigLife) -> None:
        self._rig = rig
        self._watches: dict[str, _Watch] = {}

    def of(self, name: str) -> Reaction | None:
        """None where there has been no such fault."""
        watch = self._watches.get(name)
        return None if watch is None else watch.reaction

    def begin(self, name: str, *, is_usual: bool) -> None:
        """A fault of this kind is put in now. is_usual: with the parameters that the promise is for."""
        machine = self._rig.machine
        if machine.world is None:
            return
        if name in self._watches:
            self._watches[name].end()
        now, state = machine.camera.now(), machine.loop.state
        reaction = Reaction(name, now, state, is_usual, decay_of(machine.settings))
        x, y, z = machine.settings.limits.current_A
        watch = self._watches[name] = _Watch(reaction, (x, y, z))
        watch.ends.enter_context(self._rig.watched(watch.see))
        forget: Callable[[], None] = machine.world.listen(watch.hear)
        watch.ends.callback(forget)
