"""The plate under the rigid robot: its friction differs from place to place, and from plate to plate by the seed."""

from __future__ import annotations

import math
import random

from control.simulation.rigid.parameters import RigidParameters

SLIPPERIEST = 0.1
"""Share of the mean that the friction of no patch is below (assumed)."""
_WORD = 0xFFFFFFFF


class Plate:
    """Square patches, each with a Coulomb coefficient of its own, Gaussian about the mean (assumed).

    A patch's coefficient follows from the seed and its place, so it is the same whenever the robot comes by.
    """

    def __init__(self, parameters: RigidParameters, seed: int) -> None:
        self.is_even = parameters.friction_scatter_percent == 0.0
        self._mean = parameters.friction
        self._deviation = parameters.friction * parameters.friction_scatter_percent / 100.0
        self._patch = parameters.patch_mm
        self._seed = seed
        self._known: dict[tuple[int, int], float] = {}

    def friction_at(self, x: float, y: float) -> float:
        """The Coulomb coefficient at a place, mm."""
        cell = math.floor(x / self._patch), math.floor(y / self._patch)
        friction = self._known.get(cell)
        if friction is None:
            friction = self._known[cell] = self._drawn(*cell)
        return friction

    def _drawn(self, column: int, row: int) -> float:
        place = (self._seed & _WORD) << 64 | (column & _WORD) << 32 | (row & _WORD)
        drawn = random.Random(place).gauss(self._mean, self._deviation)
        return max(drawn, SLIPPERIEST * self._mean)
