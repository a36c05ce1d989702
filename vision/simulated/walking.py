"""A robot that walks by itself: swings about its ends in turn, along a wandering course, known at every time."""

from __future__ import annotations

import bisect
import math
from dataclasses import dataclass

import numpy as np

from control.model import PIVOT_A, Body, Pivot, Pose, opposite, swing, wrap

RANGE = 0.040
"""It stays within this distance of the middle along x and y, m."""
LEAST_SWING = math.radians(2.0)
"""However the course turns, a swing is no smaller."""


@dataclass(frozen=True, slots=True)
class Stride:
    """How it walks. rate: of a swing, rad/s.  sweep: of the heading to either side of the course, rad.

    tilt: of the raised end, rad.  switch: duration of a pivot switch, s.  length: between the ends, m.
    turn: largest change of course from one swing to the next, rad.
    """

    rate: float = math.radians(80.0)
    sweep: float = math.radians(12.0)
    tilt: float = math.radians(7.0)
    switch: float = 0.050
    length: float = 0.010
    turn: float = math.radians(6.0)


@dataclass(frozen=True, slots=True)
class Swing:
    """One swing and the pivot switch after it. begin, duration: of the swing, s.  angle: signed, rad."""

    begin: float
    duration: float
    pose: Pose
    pivot: Pivot
    angle: float


class Walk:
    """The body at any time within `duration` (s); equal seeds walk alike.

    start: where it stands at first, drawn from the seed when it is not given.
    """

    def __init__(
        self,
        random: np.random.Generator,
        duration: float,
        stride: Stride | None = None,
        start: Pose | None = None,
    ) -> None:
        self._stride = stride or Stride()
        self._swings: list[Swing] = []
        pose = start or anywhere(random)
        pivot: Pivot = PIVOT_A if random.integers(2) else opposite(PIVOT_A)
        course, now = pose.heading, float(-random.uniform(0.0, 0.2))
        while now < duration:
            course += self._steering(pose, course, random)
            one = self._next(pose, pivot, course, now)
            self._swings.append(one)
            pose = swing(pose, pivot, one.angle, self._stride.length)
            now, pivot = now + one.duration + self._stride.switch, opposite(pivot)
        self._begins = [one.begin for one in self._swings]

    def body(self, time: float) -> Body:
        stride = self._stride
        one = self._swings[max(0, bisect.bisect_right(self._begins, time) - 1)]
        share = min(max((time - one.begin) / one.duration, 0.0), 1.0)
        pose = swing(one.pose, one.pivot, share * one.angle, stride.length)
        over = (time - one.begin - one.duration) / stride.switch
        if over <= 0.0:
            return Body(pose, one.pivot, stride.tilt)
        pivot = one.pivot if over < 0.5 else opposite(one.pivot)
        return Body(pose, pivot, stride.tilt * min(abs(1.0 - 2.0 * over), 1.0))

    def _steering(self, pose: Pose, course: float, random: np.random.Generator) -> float:
        """Change of course: at random, and back to the middle from the edge, rad."""
        turn = self._stride.turn
        if max(abs(pose.x), abs(pose.y)) <= RANGE:
            return float(random.uniform(-turn, turn))
        home = wrap(math.atan2(-pose.y, -pose.x) - course)
        return min(max(home, -turn), turn)

    def _next(self, pose: Pose, pivot: Pivot, course: float, begin: float) -> Swing:
        """About end A the heading turns up, about end B down: either moves the centre along the course."""
        angle = wrap(course + pivot * self._stride.sweep - pose.heading)
        angle = pivot * max(pivot * angle, LEAST_SWING)
        return Swing(begin, abs(angle) / self._stride.rate, pose, pivot, angle)


def anywhere(random: np.random.Generator) -> Pose:
    """A pose within the range of a walk."""
    x, y = random.uniform(-RANGE, RANGE, 2).tolist()
    return Pose(x, y, random.uniform(-math.pi, math.pi))
