"""The gait: a walk is a chain of sweeps, each a turn of the body by the sweep angle about one pivot.

A sweep is complete when the *body* has turned by the sweep angle (paper, section 3 and Algorithm 2); only
then may the pivot be chosen again. `Sweep` keeps that account, for the rig and for pure kinematics alike.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from control.model import Pivot

REFERENCE_TICK = 0.1
"""The paper's control tick, s: the reference moves on by the path step once per such tick."""


@dataclass(frozen=True, slots=True)
class Gait:
    """How to walk. sweep, tilt: rad.  field: T.  max_rate: rad/s.  path_step: the paper's Delta t, s."""

    sweep: float = math.radians(30.0)
    tilt: float = math.radians(25.0)
    field: float = 0.010
    max_rate: float = 2.0
    path_step: float = 0.1

    @property
    def reference_speed(self) -> float:
        """Seconds of reference per second of rig time."""
        return self.path_step / REFERENCE_TICK


@dataclass(frozen=True, slots=True)
class Counts:
    """steps: pivot switches.  sweeps: completed sweeps.  reversals: changes of the sign of the rate."""

    steps: int = 0
    sweeps: int = 0
    reversals: int = 0


class Sweep:
    """The account of one walk: the pivot in use, how far its sweep has come, and the counts so far."""

    def __init__(self, angle: float, pivot: Pivot, heading: float) -> None:
        """angle: the sweep angle, rad, > 0.  heading: the body's, unwrapped, rad."""
        self.angle = angle
        self.pivot: Pivot = pivot
        self.start = heading
        self.counts = Counts()
        self._direction = 0

    def turned(self, heading: float) -> float:
        """How far the body has turned since the sweep began, rad, signed."""
        return heading - self.start

    def remaining(self, heading: float, direction: float) -> float:
        """What is left of the sweep when turning towards `direction` (a sign), rad, >= 0."""
        return max(0.0, self.angle - math.copysign(1.0, direction) * self.turned(heading))

    def goal(self, direction: float) -> float:
        """The body's heading at which the sweep ends when turning towards `direction`, rad."""
        return self.start + math.copysign(self.angle, direction)

    def complete(self, heading: float) -> None:
        """The sweep has ended at `heading`: the next one starts there."""
        self.start = heading
        self._count(sweeps=1)

    def choose(self, pivot: Pivot) -> None:
        """Stand on `pivot` from now on; counts a step when it is another one."""
        if pivot != self.pivot:
            self.pivot = pivot
            self._count(steps=1)

    def turning(self, rate: float) -> None:
        """Take note of the sign of the rate; counts a reversal when it changes."""
        direction = (rate > 0) - (rate < 0)
        if direction == 0:
            return
        if self._direction == -direction:
            self._count(reversals=1)
        self._direction = direction

    def _count(self, steps: int = 0, sweeps: int = 0, reversals: int = 0) -> None:
        c = self.counts
        self.counts = Counts(c.steps + steps, c.sweeps + sweeps, c.reversals + reversals)


def advance_of_sweep(sweep: float, length: float) -> float:
    """Straight-line advance of the centre in one full sweep, m: L sin(sweep / 2) (paper, section 3)."""
    return length * math.sin(sweep / 2.0)
