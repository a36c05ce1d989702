"""What a pivot switch is expected to do to the robot: the measured mean, corrected by what is seen on the way."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

import numpy as np

from control.controllers.planner.moves import Complex, Float
from control.gait_model import LARGEST_TURN
from control.model import Pivot, Pose, opposite, swing

FIRST_WEIGHT = 4.0
"""The model's word counts like this many sightings."""
LEAST_GAIN = 0.05
"""Of one sighting, after many."""
BELIEVABLE = 0.15
"""A displacement of more than this share of the length is an accident, not the gait."""


@dataclass(frozen=True, slots=True)
class SwitchSlip:
    """out: of the new pivot, along the link away from the centre, m.

    forward_base, forward_per_turn: in the walking direction, m and m/rad times the turn about the old pivot.
    """

    out: float = 0.0
    forward_base: float = 0.0
    forward_per_turn: float = 0.0

    def at(self, facing: Complex, pivot: Float, turned: Float) -> Complex:
        """Displacement of the centre, m, when robots that face e^(i heading) = facing leave their `pivot`.

        turned: since that pivot was taken, rad. Walking is forward when the pivot's sign and the turn's agree.
        """
        size = np.minimum(np.abs(turned), LARGEST_TURN)
        forward = pivot * np.sign(turned) * (self.forward_base + self.forward_per_turn * size)
        return facing * (forward - 1j * self.out * pivot)


@dataclass(frozen=True, slots=True)
class Sighting:
    """A sweep began at `before` by leaving the pivot `left`, which had turned by `turned`, rad; it ended at `after`."""

    before: Pose
    left: Pivot
    turned: float
    after: Pose

    def missed(self, length: float) -> complex:
        """Where it ended less where an exact arc would have, in the axes of the robot at `before`, m."""
        turn = self.after.heading - self.before.heading
        arrival = swing(self.before, opposite(self.left), turn, length)
        apart = complex(self.after.x - arrival.x, self.after.y - arrival.y)
        return apart * cmath.exp(-1j * self.before.heading)


class SlipWatch:
    """Compares where sweeps ended with where exact arcs would have, and corrects the mean slip on line."""

    def __init__(self, expected: SwitchSlip) -> None:
        self.slip = expected
        self._seen = 0

    def see(self, sighting: Sighting, length: float) -> None:
        """Take one switch into account; length: between the pivots, m."""
        missed, turned = sighting.missed(length), sighting.turned
        if turned == 0.0 or not abs(missed) <= BELIEVABLE * length:
            return
        self._seen += 1
        gain = max(LEAST_GAIN, 1.0 / (self._seen + FIRST_WEIGHT))
        known = self.slip
        forward = missed.real * sighting.left * math.copysign(1.0, turned)
        expected = known.forward_base + known.forward_per_turn * min(abs(turned), LARGEST_TURN)
        self.slip = SwitchSlip(
            out=known.out + gain * (-missed.imag * sighting.left - known.out),
            forward_base=known.forward_base + gain * (forward - expected),
            forward_per_turn=known.forward_per_turn,
        )
