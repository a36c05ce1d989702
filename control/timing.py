"""How the loop keeps its pace: rate, period and the time from frame in to bytes out."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable

import numpy as np

from control.snapshot import Timing

KEEP = 600
"""Ticks that the figures look back on: ten seconds at 60 Hz."""
REFRESH = 30
"""Percentiles are worked out anew after this many ticks: twice a second at 60 Hz."""


class TimingLog:
    """`frame_in` when a frame arrives, `bytes_out` when its command is written."""

    def __init__(self, stopwatch: Callable[[], float]) -> None:
        """stopwatch: real seconds, whatever the rig's clock does."""
        self._stopwatch = stopwatch
        self._periods: deque[float] = deque(maxlen=KEEP)
        self._latencies: deque[float] = deque(maxlen=KEEP)
        self._last = self._frame = stopwatch()
        self._since_refresh = 0
        self._last_index: int | None = None
        self._dropped = 0
        self._timing = Timing(0.0, 0.0, 0.0, 0.0, 0)

    def frame_in(self, index: int) -> None:
        self._frame = self._stopwatch()
        self._periods.append(self._frame - self._last)
        self._last = self._frame
        if self._last_index is not None:
            self._dropped += max(0, index - self._last_index - 1)
        self._last_index = index

    def bytes_out(self) -> None:
        self._latencies.append(self._stopwatch() - self._frame)

    def figures(self) -> Timing:
        """The newest figures; cheap, worked out twice a second."""
        self._since_refresh += 1
        if self._since_refresh >= REFRESH and len(self._periods) > 1:
            self._since_refresh = 0
            self._timing = self._work_out()
        return self._timing

    def _work_out(self) -> Timing:
        periods = np.array(self._periods)
        latencies = np.array(self._latencies) if self._latencies else np.zeros(1)
        return Timing(
            rate=float(1.0 / max(periods.mean(), 1e-9)),
            period_p99=float(np.percentile(periods, 99)),
            latency_p50=float(np.percentile(latencies, 50)),
            latency_p99=float(np.percentile(latencies, 99)),
            dropped_frames=self._dropped,
        )
