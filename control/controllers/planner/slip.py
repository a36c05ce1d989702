"""What a pivot switch is expected to do to the robot: the measured mean, corrected by what is seen on the way."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

import numpy as np

from control.controllers.planner.moves import Complex, Float
from control.model import Pivot, Pose, swing

LARGEST_TURN = math.radians(40.0)
"""A longer turn about one pivot slips no further (physics.md: fitted to sweeps up to here), rad."""
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


class SlipWatch:
    """Compares where sweeps ended with where exact arcs would have, and corrects the mean slip on line."""

    def __init__(self, expected: SwitchSlip) -> None:
        self.slip = expected
        self._seen = 0

    def see(self, before: Pose, pivot: Pivot, turned: float, after: Pose, length: float) -> None:
        """A sweep began at `before` with a switch from `pivot`, which had turned by `turned`, and ended at `after`."""
        arrival = swing(before, -pivot, after.heading - before.heading, length)  # type: ignore[arg-type]
        missed = complex(after.x - arrival.x, after.y - arrival.y) * cmath.exp(-1j * before.heading)
        if turned == 0.0 or not abs(missed) <= BELIEVABLE * length:
            return
        self._seen += 1
        gain = max(LEAST_GAIN, 1.0 / (self._seen + FIRST_WEIGHT))
        size = min(abs(turned), LARGEST_TURN)
        forward = missed.real * pivot * math.copysign(1.0, turned)
        expected = self.slip.forward_base + self.slip.forward_per_turn * size
        self.slip = SwitchSlip(
            out=self.slip.out + gain * (-missed.imag * pivot - self.slip.out),
            forward_base=self.slip.forward_base + gain * (forward - expected),
            forward_per_turn=self.slip.forward_per_turn,
        )
