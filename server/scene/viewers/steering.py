"""One viewer's eye: led to a named view, or after the robot, and let go as soon as the viewer takes hold of it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from server.scene.views import Place, Stand, ViewName, less, plus

DURATION = 0.7
"""Of the way to a named view, s."""
NEAR_ENOUGH = 0.02
"""The robot moves by so much before the eye moves after it, cm: two of its pictures' pixels."""
HELD = 0.4
"""After the viewer has last moved the eye, it is left alone so long, s."""
OWN_WILL = 0.02
"""An eye that is this far from where it was led has been moved by the viewer, cm from what it looks at."""


@dataclass(frozen=True, slots=True)
class Way:
    """From where to where the eye is led, and since when, s."""

    start: Stand
    goal: Stand
    begun: float


class Steering:
    """It has no clock and no socket: told what the viewer sees, it says where the eye goes next."""

    def __init__(self) -> None:
        self.follows = False
        self.seen: Stand | None = None
        """Where the viewer's eye was last."""
        self._led: Stand | None = None
        self._way: Way | None = None
        self._held_at = -math.inf

    @property
    def busy(self) -> bool:
        return self.follows or self._way is not None

    def hear(self, seen: Stand, now: float) -> None:
        """What the viewer's browser says of its eye."""
        before, self.seen = self.seen, seen
        if self._way is None and before is not None and turned(before, seen):
            self._held_at = now

    def ask(self, name: ViewName, goal: Stand, now: float, *, smooth: bool) -> None:
        self.follows = name == "follow"
        self._held_at = -math.inf
        start = self.seen if smooth and self.seen is not None else goal
        self._way = Way(start, goal, now if smooth else now - DURATION)

    def step(self, robot: Place | None, now: float) -> Stand | None:
        """Where the eye goes now; None where it stays."""
        if self._way is not None:
            return self._on_the_way(self._way, now)
        if not self.follows or robot is None or self._led is None or now - self._held_at < HELD:
            return None
        return self._after(robot)

    def _on_the_way(self, way: Way, now: float) -> Stand:
        share = min(1.0, (now - way.begun) / DURATION)
        if share >= 1.0:
            self._way = None
        self._led = way.start.towards(way.goal, share * share * (3.0 - 2.0 * share))
        return self._led

    def _after(self, robot: Place) -> Stand | None:
        """The robot comes back to the middle, seen from the side and distance that the viewer has chosen."""
        eye = self.seen or self._led
        if eye is None or self._led is None or math.dist(robot, self._led.look_at) < NEAR_ENOUGH:
            return None
        self._led = Stand(plus(robot, less(eye.position, eye.look_at)), robot, eye.up)
        return self._led


def turned(before: Stand, after: Stand) -> bool:
    """Whether the eye stands elsewhere around what it looks at."""
    offsets = less(before.position, before.look_at), less(after.position, after.look_at)
    return math.dist(*offsets) > OWN_WILL
