"""How late the camera's frames come, and how many a second."""

from __future__ import annotations

from collections import deque
from statistics import fmean, median

from control.snapshot import CameraTiming

KEEP = 60
"""Frames that the figures look back on: one second at 60 Hz."""


class FrameLog:
    """Told of each frame that is looked at."""

    def __init__(self) -> None:
        self._delays: deque[float] = deque(maxlen=KEEP)
        self._periods: deque[float] = deque(maxlen=KEEP)
        self._captured_at: float | None = None

    def came(self, captured_at: float, now: float) -> None:
        """A frame of `captured_at` was handed in at `now`, s; one that repeats a time tells nothing."""
        if self._captured_at is not None and captured_at > self._captured_at:
            self._periods.append(captured_at - self._captured_at)
        self._captured_at = captured_at
        self._delays.append(now - captured_at)

    @property
    def figures(self) -> CameraTiming:
        """Over the last frames."""
        return CameraTiming(
            latency=median(self._delays) if self._delays else None,
            rate=1.0 / fmean(self._periods) if self._periods else None,
        )
