"""How the rigid robot lies in space, in plain numbers: it is read a thousand times a second."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from control.snapshot import Vector


@dataclass(frozen=True, slots=True)
class Attitude:
    """The body's centre on the plate, mm, and its axes as unit vectors: across (the walking direction), along, up."""

    x: float
    y: float
    across: Vector
    along: Vector
    up: Vector

    @classmethod
    def of(cls, state: Sequence[float]) -> Attitude:
        """state: position, mm, and unit quaternion, as MuJoCo keeps them."""
        x, y, _, w, i, j, k = state
        across = 1.0 - 2.0 * (j * j + k * k), 2.0 * (i * j + w * k), 2.0 * (i * k - w * j)
        along = 2.0 * (i * j - w * k), 1.0 - 2.0 * (i * i + k * k), 2.0 * (j * k + w * i)
        up = 2.0 * (i * k + w * j), 2.0 * (j * k - w * i), 1.0 - 2.0 * (i * i + j * j)
        return cls(x, y, across, along, up)

    @property
    def heading(self) -> float:
        """Of the axis across, which points in the walking direction, rad."""
        return math.atan2(self.across[1], self.across[0])

    @property
    def pitch(self) -> float:
        """Elevation of end A over end B, rad."""
        return math.asin(max(-1.0, min(1.0, self.along[2])))

    def at(self, x: float, y: float, z: float) -> tuple[float, float]:
        """Where a point of the body is on the plate, mm."""
        (ax, ay, _), (bx, by, _), (cx, cy, _) = self.across, self.along, self.up
        return self.x + ax * x + bx * y + cx * z, self.y + ay * x + by * y + cy * z
