"""The straight way from where the robot stands to the start of its path."""

from __future__ import annotations

import math

from control.trajectories.pieces import NEGLIGIBLE, Point, towards
from control.trajectories.trajectory import Path


class Approach:
    """A straight line at constant speed, and then the path, whose clock starts when the line ends."""

    def __init__(self, start: Point, path: Path, pace: float) -> None:
        """start: m.  pace: along the line, m/s."""
        self.path = path
        self.closed = path.closed
        self.duration = path.duration
        self._start, self._end = start, path.point(0.0)
        self._pace = pace
        distance = math.dist(self._start, self._end)
        self.lead = distance / pace if distance > NEGLIGIBLE else 0.0
        """How long the line takes, s."""

    def point(self, time: float) -> Point:
        if time < self.lead:
            return towards(self._start, self._end, self._pace * max(0.0, time))
        return self.path.point(time - self.lead)
