"""The gait: a walk is a chain of sweeps, each a turn of the body by the sweep angle about one pivot.

A sweep is complete when the *body* has turned by the sweep angle (paper, section 3 and Algorithm 2); only
then may the pivot be chosen again. `Sweep` keeps that account, for the rig and for pure kinematics alike.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum

from control.model import Pivot

REFERENCE_TICK = 0.1
"""The paper's control tick, s: the reference moves on by the path step once per such tick."""
ROUNDING = 1e-9
"""A step that is missing by rounding alone is not taken."""


class TimeLaw(StrEnum):
    """How the reference moves along its path; see `control.trajectories.time_law`."""

    PATH_STEP = "path_step"
    CONSTANT_SPEED = "constant_speed"
    TRAPEZOIDAL = "trapezoidal"
    WAIT = "wait"


@dataclass(frozen=True, slots=True)
class Gait:
    """How to walk. sweep, tilt: rad.  field: T.  max_rate: rad/s.

    time_law: how the reference moves.  path_step: the paper's Delta t, s.  speed: of the reference by the other
    laws, m/s.  acceleration: m/s^2.  wait_distance: how far ahead of the robot it goes when it waits, m.
    approach: walk straight to the start of the path before the path begins.
    """

    sweep: float = math.radians(30.0)
    tilt: float = math.radians(25.0)
    field: float = 0.010
    max_rate: float = 2.0
    path_step: float = 0.1
    time_law: TimeLaw = TimeLaw.PATH_STEP
    speed: float = 0.003
    acceleration: float = 0.002
    wait_distance: float = 0.005
    approach: bool = False

    @property
    def reference_speed(self) -> float:
        """Seconds of the path's own clock per second of rig time, by the law of the path step."""
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
        return remaining_turn(self.angle, self.turned(heading), direction)

    def goal(self, direction: float) -> float:
        """The body's heading at which the sweep ends when turning towards `direction`, rad."""
        return sweep_end(self.start, self.angle, direction)

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


def remaining_turn(angle: float, turned: float, direction: float) -> float:
    """What is left of a sweep of `angle` when turning towards `direction` (a sign), rad, >= 0."""
    return max(0.0, angle - math.copysign(1.0, direction) * turned)


def sweep_end(start: float, angle: float, direction: float) -> float:
    """The heading at which a sweep of `angle` from `start` ends when turning towards `direction`, rad."""
    return start + math.copysign(angle, direction)


def advance_of_sweep(sweep: float, length: float) -> float:
    """Straight-line advance of the centre in one full sweep, m: L sin(sweep / 2) (paper, section 3)."""
    return length * math.sin(sweep / 2.0)


def steps_for_distance(distance: float, sweep: float, length: float) -> int:
    """Steps that a straight walk of `distance` (m) takes, the half one at the start included.

    ceil(D / (L sin(sweep / 2)) + 1/2) (paper, section 3, made exact): the first step advances half as far as
    the others. Fewest near 180 degrees; without end at 0 and 360, where no step advances.
    """
    return math.ceil(distance / advance_of_sweep(sweep, length) + 0.5 - ROUNDING)


def detour(sweep: float) -> float:
    """Way that the centre travels per way that it gets on: (sweep / 2) / sin(sweep / 2) (paper, section 3)."""
    return (sweep / 2.0) / math.sin(sweep / 2.0)
