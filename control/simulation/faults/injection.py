"""The faults that a simulated rig has now: put in, taken away, over after a while, coming and going.

`inject` belongs to the thread that moves the world, as `attend` does, which the world calls whenever its time
goes on; `clear` may come from any thread and takes effect at the next step of the world, even where that is
taken by a loop that hangs.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from control.registry import Parameters, UnknownName
from control.simulation.faults import board, camera, computer, disk, limits, line
from control.simulation.faults.kind import Family, FaultKind
from control.simulation.faults.points import FaultPoints

KINDS: dict[str, FaultKind] = {
    kind.name: kind for room in (camera, line, board, computer, limits, disk) for kind in room.KINDS
}
"""The catalogue, by name."""

Announce = Callable[[str, str, str], None]
"""Told of every change: severity, code, sentence."""


@dataclass(frozen=True, slots=True)
class Pattern:
    """A fault that comes and goes: there for `on` seconds, away for `off`."""

    on: float
    off: float

    def is_on(self, elapsed: float) -> bool:
        return elapsed % (self.on + self.off) < self.on


ALWAYS = Pattern(math.inf, 0.0)


@dataclass(slots=True)
class Injection:
    """A fault that is in. since, until: rig time, s.  is_on: the switch is thrown just now."""

    kind: FaultKind
    parameters: Parameters
    since: float
    until: float
    pattern: Pattern
    is_on: bool = False
    is_cleared: bool = False


class Faults:
    """What is injected into one rig; `clock` is the rig's, s."""

    def __init__(self, points: FaultPoints, clock: Callable[[], float], announce: Announce) -> None:
        self._points = points
        self._clock = clock
        self._announce = announce
        self._injections: dict[str, Injection] = {}

    def __iter__(self) -> Iterator[Injection]:
        return iter(list(self._injections.values()))

    def get(self, name: str) -> Injection | None:
        """The injection of that name, None while there is none; raises `UnknownName`."""
        kind_named(name)
        return self._injections.get(name)

    def inject(
        self,
        name: str,
        parameters: Mapping[str, Any] | None = None,
        duration: float = math.inf,
        pattern: Pattern = ALWAYS,
    ) -> Injection:
        """Put a fault in, in place of one of the same name; raises `UnknownName` or pydantic's ValidationError."""
        kind = kind_named(name)
        values = kind.parameters.model_validate(dict(parameters or {}))
        self._take_out(name)
        now = self._clock()
        injection = Injection(kind, values, now, now + duration, pattern)
        kind.begin(self._points, values)
        self._announce("warn", "injected", f"injected: {kind.title}")
        injection.is_on = True
        if not kind.happens_once:
            self._injections[name] = injection
        return injection

    def clear(self, name: str) -> None:
        """Take a fault away; nothing to do when it is not in. Raises `UnknownName`."""
        injection = self.get(name)
        if injection is not None:
            injection.is_cleared = True

    def clear_all(self) -> None:
        for injection in self:
            injection.is_cleared = True

    def attend(self) -> None:
        """What is due now."""
        if not self._injections:
            return
        now = self._clock()
        for name, injection in list(self._injections.items()):
            if injection.is_cleared or now >= injection.until:
                self._take_out(name)
            elif injection.pattern.is_on(now - injection.since) != injection.is_on:
                self._toggle(injection)

    def _take_out(self, name: str) -> None:
        injection = self._injections.pop(name, None)
        if injection is None:
            return
        if injection.is_on:
            self._end(injection)
        self._announce("info", "injected", f"no longer injected: {injection.kind.title}")

    def _toggle(self, injection: Injection) -> None:
        if injection.is_on:
            self._end(injection)
        else:
            injection.kind.begin(self._points, injection.parameters)
        injection.is_on = not injection.is_on

    def _end(self, ended: Injection) -> None:
        """Put the switch back, but for who else has thrown the same: a supply that is off and low stays off."""
        ended.kind.end(self._points)
        for other in self:
            if other is not ended and other.is_on and other.kind.family is ended.kind.family is Family.BOARD:
                other.kind.begin(self._points, other.parameters)


def kind_named(name: str) -> FaultKind:
    kind = KINDS.get(name)
    if kind is None:
        raise UnknownName("fault", name, list(KINDS))
    return kind
