"""A simulated hand-held magnetometer: the true field of the simulated coils, the room's, and a shaky hand."""

from __future__ import annotations

import random

import numpy as np

from control.axes import AXES, Axis
from control.coils import field_per_ampere
from control.simulation.world import World
from control.snapshot import Vector

ROOM = (18e-6, 4e-6, -44e-6)
"""The earth's field in central Europe, T."""
NOISE = 20e-6
"""Standard deviation of one reading, T (assumed: a Hall probe with a resolution of 0.01 mT)."""
SCALE_NOISE = 0.005
"""Standard deviation of one reading as a share of it (assumed: the probe is a few degrees askew)."""


class Magnetometer:
    """Reads the world as it is now."""

    def __init__(self, world: World, seed: int) -> None:
        self._world = world
        self._random = random.Random(seed)

    def read(self, point: Vector, component: Axis) -> float:
        """One component of the field (T) at `point` (m), both in the coils' frame."""
        index = AXES.index(component)
        per_ampere = field_per_ampere(self._world.coils.pairs, np.array([point]))[0, index]
        field = float(per_ampere @ np.array(self._world.currents)) + ROOM[index]
        return self._random.gauss(field * self._random.gauss(1.0, SCALE_NOISE), NOISE)
