"""Other robots that walk or stand next to the robot without touching it, and a hand that covers them all."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from control.model import PIVOT_A, Body, Pose
from vision.simulated.company import hand
from vision.simulated.figures import Figure
from vision.simulated.props import Prop, Setup
from vision.simulated.scenes import Scene
from vision.simulated.walking import Stride, Walk

NEAREST, FARTHEST = 0.010, 0.020
"""From the robot's centre to another one's, m: one to two body lengths."""
GAP = 0.0008
"""Between their outlines, m: three pixels, for robots do not overlap."""
REACH = 0.052
"""They stay in the picture, m."""
TRIES = 300
CHECKED_EVERY = 0.1
"""s; a robot walks less than a millimetre meanwhile."""

Path = Callable[[float], Body]


@dataclass(frozen=True, slots=True)
class Company:
    """count: of the others; fewer where there is no room.  scale: how many times as long and wide as the robot."""

    count: int = 1
    scale: float = 1.0
    walking: bool = True

    def __call__(self, setup: Setup) -> Prop:
        paths = [path for _ in range(self.count) if (path := self._beside(setup)) is not None]
        look = replace(
            setup.settings.look,
            length=self.scale * setup.settings.length,
            width=self.scale * setup.settings.width,
        )
        return lambda extras, moment: replace(
            extras, company=(*extras.company, *(Figure((path(moment.time),), look) for path in paths))
        )

    def _beside(self, setup: Setup) -> Path | None:
        drawn = (self._drawn(setup) for _ in range(TRIES))
        return next((path for path in drawn if self._is_clear(setup, path)), None)

    def _drawn(self, setup: Setup) -> Path:
        random = setup.random
        assert setup.path is not None
        robot = setup.path(random.uniform(0.0, setup.duration)).pose
        bearing, distance = random.uniform(-math.pi, math.pi), random.uniform(NEAREST, FARTHEST)
        x, y = robot.x + distance * math.cos(bearing), robot.y + distance * math.sin(bearing)
        pose = Pose(x, y, random.uniform(-math.pi, math.pi))
        if self.walking:
            return Walk(random, setup.duration, Stride(length=self.scale * setup.settings.length), pose).body
        return lambda _: Body(pose, PIVOT_A, 0.0)

    def _is_clear(self, setup: Setup, path: Path) -> bool:
        assert setup.path is not None
        times = np.arange(0.0, setup.duration + CHECKED_EVERY, CHECKED_EVERY).tolist()
        pairs = [(setup.path(time), path(time)) for time in times]
        return all(_is_apart(*pair) for pair in pairs) and all(
            self._gap(setup, *pair) >= GAP for pair in pairs
        )

    def _gap(self, setup: Setup, robot: Body, other: Body) -> float:
        length, width = setup.settings.length, setup.settings.width
        return _gap(_corners(robot, length, width), _corners(other, self.scale * length, self.scale * width))


def _is_apart(robot: Body, other: Body) -> bool:
    inside = max(abs(other.pose.x), abs(other.pose.y)) <= REACH
    return inside and robot.pose.distance_to(other.pose.x, other.pose.y) >= NEAREST


def _corners(body: Body, length: float, width: float) -> NDArray:
    """(4, 2) m, in order round the body."""
    c, s = math.cos(body.pose.heading), math.sin(body.pose.heading)
    along, across = np.array([-s, c]) * 0.5 * length, np.array([c, s]) * 0.5 * width
    centre = np.array([body.pose.x, body.pose.y])
    return centre + np.array([along + across, along - across, -along - across, -along + across])


def _gap(one: NDArray, other: NDArray) -> float:
    """Between two rectangles along the axis that separates them best, m; below 0 when they overlap."""
    gaps = []
    for first, second, third, _ in (one, other):
        for edge in (second - first, third - second):
            axis = edge / np.hypot(*edge)
            here, there = one @ axis, other @ axis
            gaps.append(max(float(there.min() - here.max()), float(here.min() - there.max())))
    return max(gaps)


KINDS = {
    "an identical one that walks": Company(),
    "two identical ones that stand": Company(2, walking=False),
    "a larger one that walks": Company(scale=1.3),
    "two that walk": Company(2),
    "a larger one that stands": Company(scale=1.4, walking=False),
}


def covered_among(kind: str, longest: float = 0.6) -> Scene:
    """A hand covers the robot, and who is next to it, for up to `longest` (s)."""
    return Scene(kind, (KINDS[kind], hand(longest, 0.15)))


def free_among(kind: str) -> Scene:
    return Scene(kind, (KINDS[kind],))
