"""What must hold at every moment of a soak, as a client of the telemetry sees it: I1, I3 and I4 of faults.md.

Times are the rig's own, s, but for `arrived` and `asked`, which are monotonic.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from control.simulation.faults.injection import KINDS
from control.simulation.faults.kind import Family
from control.simulation.lockstep import Sample
from control.snapshot import Vector
from tests.faults.invariants import ANNOUNCED_WITHIN, ENERGISED, GONE, OVERSHOOT, Electrics, check_limits
from tests.faults.promises import PROMISES
from tests.soak.broken import InvariantBroken

NOT_SENSED = frozenset({"sense_dead", "sense_wrong", "report_nan"})
"""Faults of what the board measures or tells."""
REPORT_LATE = 0.3
"""A report of the board may be as old as this before it counts as missing, s (faults.md: telemetry stale)."""
SETTLED = 0.5
"""After a fault was taken away what the board measures counts again, s."""
LAG = 1.0
"""A tick may reach a client as late as this on a busy computer, s: what was asked for so long before the rig was
seen at rest may still be what drives it afterwards."""
ON = frozenset(state.value for state in ENERGISED)


def is_blind(name: str) -> bool:
    """Whether this fault makes what the board measures unknown or wrong."""
    return name in NOT_SENSED or KINDS[name].family is Family.LINE


@dataclass(slots=True)
class LiveRules:
    """Fed with all that one client is sent. electrics: what currents are held against."""

    electrics: Electrics
    largest: float = 0.0
    """Measured current, as a share of its limit."""
    slowest_line: float = 0.0
    """From an event to its arrival, s."""
    ticks: int = 0
    _faults: frozenset[str] = frozenset()
    _faulty_until: float = 0.0
    _asleep: float = 0.0
    _now: float = 0.0
    _rested_since: float | None = None
    _rested_arrival: float = 0.0
    _seen_on: bool = field(default=False)

    def begin(self, names: frozenset[str]) -> None:
        """These faults are put in now."""
        self._asleep = sum(PROMISES[name].asleep for name in names) * 1e-3
        self._faults = names

    def end(self) -> None:
        """All faults have been taken away."""
        self._faulty_until = self._now + SETTLED + self._asleep
        self._faults = frozenset()

    def tick(self, tick: Mapping[str, Any], arrived: float, asked: float) -> None:
        self.ticks += 1
        self._now = tick["time_s"]
        commanded, measured = _vector(tick["currents_A"]), _vector(tick["measured_currents_A"])
        check_limits([self._sample(commanded)], self.electrics, 0.0001)
        if self._sees(tick):
            check_limits([self._sample(measured)], self.electrics, OVERSHOOT)
            shares = zip(measured, self.electrics.currents, strict=True)
            self.largest = max(self.largest, *(abs(current) / limit for current, limit in shares))
        self._check_rest(tick, commanded, measured, arrived, asked)

    def event(self, event: Mapping[str, Any]) -> None:
        """I4: the log reaches everybody within a second."""
        late = self._now - event["time_s"]
        allowed = ANNOUNCED_WITHIN + self._asleep
        self.slowest_line = max(self.slowest_line, late - self._asleep)
        if late > allowed:
            raise InvariantBroken(f"I4: {event['code']!r} was told {late:.2f} s after it was found")

    def _sample(self, currents: Vector) -> Sample:
        return Sample(round(self._now * 1e3), currents, (0, 0, 0))

    def _sees(self, tick: Mapping[str, Any]) -> bool:
        if tick["link"]["state"] != "ready" or self._now < self._faulty_until:
            return False
        return not any(is_blind(name) for name in self._faults)

    def _check_rest(
        self, tick: Mapping[str, Any], commanded: Vector, measured: Vector, arrived: float, asked: float
    ) -> None:
        """I2 and I3: at rest no current flows, and the rig leaves its rest only when it is asked to."""
        if tick["rig"] in ON:
            if self._rested_since is not None and asked < self._rested_arrival - LAG:
                raise InvariantBroken(f"I3: {tick['rig']} without being asked: {tick['reason']}")
            self._rested_since = None
            return
        if self._rested_since is None:
            self._rested_since, self._rested_arrival = self._now, arrived
        gone_by = self._rested_since + self.electrics.decay * 1e-3 + REPORT_LATE
        if self._now > gone_by and self._sees(tick):
            if any(commanded):
                raise InvariantBroken(
                    f"I3: {commanded} A are commanded while {tick['rig']}: {tick['reason']}"
                )
            for axis, current, limit in zip("xyz", measured, self.electrics.currents, strict=True):
                if not abs(current) <= GONE * limit:
                    raise InvariantBroken(
                        f"I3: {current:.2f} A in coil {axis} while {tick['rig']}: {tick['reason']}"
                    )


def _vector(values: list[float]) -> Vector:
    x, y, z = values
    return x, y, z
