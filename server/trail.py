"""Where the robot has been, for drawing."""

from __future__ import annotations

from collections import deque

import numpy as np
from numpy.typing import NDArray

from control.snapshot import Snapshot

POINTS = 600
"""The trail reaches back a minute at ten points a second."""
EVERY = 6
"""Ticks from one point to the next."""


class Trail:
    def __init__(self) -> None:
        self._points: deque[tuple[float, float]] = deque(maxlen=POINTS)

    def follow(self, snapshot: Snapshot) -> None:
        if snapshot.pose is not None and snapshot.tick % EVERY == 0:
            self._points.append((snapshot.pose.x, snapshot.pose.y))

    def clear(self) -> None:
        self._points.clear()

    def points(self) -> NDArray[np.float64]:
        """(n, 2) estimates, m, oldest first."""
        return np.array(self._points, dtype=float).reshape(-1, 2)
