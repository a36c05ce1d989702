"""The length walked along a path, as a function of the path's own clock and back."""

from __future__ import annotations

import bisect
from functools import cached_property

import numpy as np

from control.trajectories.trajectory import Path, points_of

STEPS = 4000
"""Chords of a tenth of a millimetre on the paper's eight, whose length they find to a part in a million."""


class ArcLength:
    """Lengths along one pass, measured when first asked for; times and lengths may go on over many passes."""

    def __init__(self, path: Path) -> None:
        self.path = path

    @cached_property
    def whole(self) -> float:
        """Length of one pass, m."""
        return self._lengths[-1]

    def length_at(self, time: float) -> float:
        """Length walked at `time` (s) of the path's clock, m."""
        passes, within = divmod(time, self.path.duration)
        steps = within / self.path.duration * STEPS
        before = min(int(steps), STEPS - 1)
        here, there = self._lengths[before : before + 2]
        return passes * self.whole + here + (steps - before) * (there - here)

    def time_at(self, length: float) -> float:
        """Time of the path's clock at which `length` (m) has been walked, s."""
        passes, within = divmod(length, self.whole)
        before = min(bisect.bisect_right(self._lengths, within), STEPS) - 1
        here, there = self._lengths[before : before + 2]
        share = (within - here) / (there - here) if there > here else 0.0
        return self.path.duration * (passes + (before + share) / STEPS)

    @cached_property
    def _lengths(self) -> list[float]:
        steps = np.diff(points_of(self.path, STEPS + 1), axis=0)
        return [0.0, *np.cumsum(np.hypot(steps[:, 0], steps[:, 1])).tolist()]
