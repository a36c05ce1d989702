"""The recordings of a soak's runs, read back when they are over: I1, I3, I5 and I6 of faults.md at every tick."""

from __future__ import annotations

import math
import statistics
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from control.simulation.lockstep import Sample
from server.recording.reading.recording import Recording, Unreadable
from tests.faults.invariants import LONGEST_PERIOD, Electrics, check_limits, check_recording
from tests.soak.broken import InvariantBroken
from tests.soak.live_rules import ON

ROUNDING = 1e-4
"""Share of its limit by which a commanded current, which is rounded, may pass it."""
LONG_SHARE = 0.02
"""Share of the ticks outside faults that may come later than the longest period of a rig with a computer of its own:
the load has both processors too, and what it takes now and then is told, while more is a loop that is not unharmed."""

Window = tuple[float, float]
"""Rig times between which a fault itself may hold the loop up, s."""


@dataclass(slots=True)
class Pace:
    """Periods of the loop while no fault is in, s."""

    periods: list[float] = field(default_factory=list)

    def add(self, times: Iterable[float], except_for: Iterable[Window]) -> None:
        windows = tuple(except_for)
        last: float | None = None
        for time in times:
            if last is not None and not any(since <= time <= until for since, until in windows):
                self.periods.append(time - last)
            last = time

    @property
    def long_share(self) -> float:
        late = sum(period > LONGEST_PERIOD for period in self.periods)
        return late / len(self.periods) if self.periods else 0.0

    @property
    def rate(self) -> float:
        """Ticks a second."""
        return 1.0 / statistics.fmean(self.periods) if self.periods else math.nan

    @property
    def worst(self) -> float:
        return max(self.periods, default=math.nan)

    def check(self) -> None:
        """I6."""
        if self.long_share > LONG_SHARE:
            raise InvariantBroken(
                f"I6: {100 * self.long_share:.1f} % of the ticks without a fault came later than "
                f"{1e3 * LONGEST_PERIOD:.0f} ms after the last; {100 * LONG_SHARE:.0f} % are allowed"
            )


@dataclass(frozen=True, slots=True)
class Auditor:
    """Reads each recording once. data: the server's folder."""

    data: Path
    electrics: Electrics
    pace: Pace = field(default_factory=Pace)

    def read(self, run: str, faults: Iterable[float], windows: Iterable[Window], *, is_whole: bool) -> int:
        """The number of its ticks. faults: when there was one while the run was on, rig time, s.

        is_whole: no fault of the disk has cut it short.
        """
        path = self.path_of(run)
        for fault in faults:
            check_recording(path, fault)
        try:
            with Recording.open(path) as recording:
                if is_whole and not recording.is_whole:
                    raise InvariantBroken(f"I5: {path.name} has no end")
                times = [self._checked(time, tick) for time, tick in _ticks(recording)]
                broken = recording.damaged_chunks + recording.unread_messages
        except Unreadable as error:
            raise InvariantBroken(f"I5: {error}") from error
        if broken:
            raise InvariantBroken(f"I5: {broken} pieces of {path.name} make no sense")
        self.pace.add(times, windows)
        return len(times)

    def path_of(self, run: str) -> Path:
        """Raises `InvariantBroken` where there is none."""
        found = next(iter(self.data.rglob(f"{run}*.mcap")), None)
        if found is None:
            raise InvariantBroken(f"I5: there is no recording of the run {run}")
        return found

    def _checked(self, time: float, tick: dict[str, dict]) -> float:
        x, y, z = tick["/currents"]["commanded_A"]
        check_limits([Sample(round(time * 1e3), (x, y, z), (0, 0, 0))], self.electrics, ROUNDING)
        state = tick["/state"]
        if state["rig"] not in ON and any((x, y, z)):
            raise InvariantBroken(
                f"I3: {x}, {y}, {z} A are commanded while {state['rig']} at {time:.2f} s: {state['reason']}"
            )
        return time


def _ticks(recording: Recording) -> Iterator[tuple[float, dict[str, dict]]]:
    """Those that are complete: the last one of a recording that was cut short may not be."""
    for tick in recording.ticks(topics=("/state", "/currents")):
        if "/state" in tick and "/currents" in tick:
            yield tick["/state"]["time_s"], tick
