"""The recordings of a soak's runs, read back when they are over: I1, I3, I5 and I6 of faults.md at every tick."""

from __future__ import annotations

import math
import statistics
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from control.simulation.lockstep import Sample
from server.recording.reading.recording import Recording, Unreadable
from server.recording.reading.tick_reading import Tick
from tests.faults.invariants import LONGEST_PERIOD, Electrics, check_limits, check_recording
from tests.soak.broken import InvariantBroken
from tests.soak.live_rules import ON

ROUNDING = 1e-4
"""Share of its limit by which a commanded current, which is rounded, may pass it."""
LONG_SHARE = 0.005
"""Share of the ticks outside faults that may come later than the longest period of a rig with a computer of its own
without a reason; exports and replays take the interpreter for a moment (measured on two cores: 0.02 %)."""
SHORTEST_WAIT = LONGEST_PERIOD - 1.0 / 60.0
"""What makes a tick of a camera of 60 Hz so late, s: so many of the late ones are the machine's, whose load has both
processors too, for each such time that the rig was kept from a processor."""
OFF_WITHIN = 0.35
"""A report that comes so long after the rig went to rest is of a board without drive, s: a slow line's 150 ms behind
the dead-man's 200 ms."""
TOPICS = frozenset({"/state", "/currents", "/field"})

Window = tuple[float, float]
"""Rig times between which a fault itself may hold the loop up, s."""


@dataclass(slots=True)
class Pace:
    """Periods of the loop while no fault is in, s."""

    periods: list[float] = field(default_factory=list)

    def add(self, times: Iterable[float], except_for: Iterable[Window]) -> None:
        times = list(times)
        windows = [w for w in except_for if times and w[0] <= times[-1] and times[0] <= w[1]]
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

    def check(self, starved: float) -> None:
        """I6. starved: how long the rig was kept from the processor in all, s."""
        late = sum(period > LONGEST_PERIOD for period in self.periods)
        allowed = LONG_SHARE * len(self.periods) + starved / SHORTEST_WAIT
        if late > allowed:
            raise InvariantBroken(
                f"I6: of {len(self.periods)} ticks without a fault {late} came later than {1e3 * LONGEST_PERIOD:.0f} ms"
                f" after the last; {allowed:.0f} may, with {starved:.1f} s in which the rig was kept from the processor"
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
                rest = Rest()
                times = [self._checked(tick, rest) for tick in _ticks(recording)]
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

    def _checked(self, tick: Tick, rest: Rest) -> float:
        """Its rig time, s."""
        x, y, z = tick["/currents"]["commanded_A"]
        state, board = tick["/state"], tick["/field"]
        time = state["time_s"]
        check_limits([Sample(round(time * 1e3), (x, y, z), (0, 0, 0))], self.electrics, ROUNDING)
        told = board.get("board_received_s", -math.inf)
        if rest.forbids(state["rig"] in ON, time, told) and (board["is_on"] or any((x, y, z))):
            raise InvariantBroken(
                f"I3: {x}, {y}, {z} A are commanded while {state['rig']} at {time:.2f} s: {state['reason']}"
            )
        return time


@dataclass(slots=True)
class Rest:
    """Whether the board has said so late in a rest that it must be without drive."""

    _since: float | None = None

    def forbids(self, is_on: bool, time: float, told: float) -> bool:
        """is_on: the rig may drive.  told: when the board's newest report came, s."""
        if is_on:
            self._since = None
            return False
        if self._since is None:
            self._since = time
        return told > self._since + OFF_WITHIN


def _ticks(recording: Recording) -> Iterator[Tick]:
    """Those that are complete: the last one of a recording that was cut short may not be."""
    for tick in recording.ticks(topics=TOPICS):
        if tick.keys() >= TOPICS:
            yield tick
