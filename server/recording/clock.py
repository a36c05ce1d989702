"""From the rig's clock to UTC: the start of the run is the one instant at which both are read."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from server.recording.reading.recording import Recording

NANO = 1_000_000_000
_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)


class RunClock:
    """start: the run's start, UTC ns.  zero: the same instant in rig time, s."""

    def __init__(self, started_at: datetime, zero: float) -> None:
        self.start = (started_at - _EPOCH) // timedelta(microseconds=1) * 1000
        self.zero = zero
        self._newest = 0

    def since_start(self, time: float) -> float:
        """Of a rig time; s."""
        return time - self.zero

    def utc(self, time: float) -> int:
        """Of a rig time, s; ns since 1970."""
        return max(self.start + round((time - self.zero) * NANO), 0)

    def tick(self, time: float) -> int:
        """Log time of the tick at that rig time: later than that of all before, even if rig time stood still."""
        self._newest = max(self.utc(time), self._newest + 1)
        return self._newest

    @property
    def newest(self) -> int:
        """Log time of the newest tick; what is told beside the ticks bears it, so that times never go back."""
        return self._newest or self.start


def rig_time_of_start(recording: Recording) -> float:
    """Rig time at which a recorded run began, s: each tick has both times. 0 where no tick tells it."""
    for entry in recording.messages(["/state"]):
        time = entry.data.get("time_s") if isinstance(entry.data, dict) else None
        if isinstance(time, int | float):
            return time - entry.time_s
    return 0.0
