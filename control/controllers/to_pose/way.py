"""How much walking is left from where a robot stands to a wanted pose: an estimate, in whole sweeps.

In the frame of the wanted pose the place is complex (m), with the wanted heading along the real axis. There are two
ways: turn towards the place, walk straight (forwards or backwards), turn; or, from near by, along the heading and
sideways as a car parks: turning to and fro on alternate pivots by an angle a displaces the centre sideways by
L (2 sin(a / 2))^2 in four sweeps.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from control.controllers.planner.moves import Complex, Float

SIDEWAYS_SWEEPS = 4.0
"""Sweeps of one displacement sideways."""
CENTRED = 0.5
"""What the edge of the tolerance costs against its middle, in sweeps: less than any sweep."""
EAGER = 1.2
"""What is left counts for more than the sweeps that it would take at best, so that it pays to go there."""


@dataclass(frozen=True, slots=True)
class Tolerance:
    """Within which the robot is there: place in m, heading in rad."""

    place: float
    heading: float


@dataclass(frozen=True, slots=True)
class WayToGo:
    """length: between the pivots, m.  sweep: the widest that is made, rad."""

    length: float
    sweep: float
    tolerance: Tolerance

    @property
    def advance(self) -> float:
        """Of one sweep in the middle of a straight walk, m."""
        return self.length * math.sin(0.5 * self.sweep)

    def sweeps(self, place: Complex, facing: Complex) -> Float:
        """From robots at `place` with the heading e^(i heading) = facing, both in the wanted pose's frame."""
        turn, distance = np.abs(np.angle(facing)), np.abs(place)
        left = np.minimum(self._turning(place, facing), self._sideways(place, turn))
        is_there = self.is_there(place, facing)
        off = np.square(distance / self.tolerance.place) + np.square(turn / self.tolerance.heading)
        return np.where(is_there, 0.0, 1.0 + EAGER * left) + CENTRED * np.minimum(0.5 * off, 1.0)

    def is_there(self, place: Complex, facing: Complex) -> NDArray[np.bool_]:
        """Whether nothing is left to do."""
        near = np.abs(place) <= self.tolerance.place
        return near & (np.abs(np.angle(facing)) <= self.tolerance.heading)

    def _turning(self, place: Complex, facing: Complex) -> Float:
        """Turn, walk, turn; the walk leads to the origin, with the robot facing it or its back to it."""
        towards = np.where(place == 0.0, 1.0, -place)
        turns = [np.abs(np.angle(way * facing.conj())) + np.abs(np.angle(way)) for way in (towards, -towards)]
        return np.minimum(*turns) / self.sweep + np.abs(place) / self.advance

    def _sideways(self, place: Complex, turn: Float) -> Float:
        reach = self.length * (2.0 * math.sin(0.5 * self.sweep)) ** 2
        share = np.abs(place.imag) / reach
        aside = SIDEWAYS_SWEEPS * np.maximum(np.sqrt(share), share)
        return turn / self.sweep + np.abs(place.real) / self.advance + aside
