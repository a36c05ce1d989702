"""Where the coils stand in the camera's workspace, and which way round the robot's magnet lies.

The camera's calibration makes the workspace's frame; the coils have one of their own, with its origin in
their middle and its x axis along the x pair. A point p of the workspace is q = R^T (p - o) for the coils, and
a field b of theirs is R b in the workspace: K(p) = R K_coils(R^T (p - o)). All this is in the plate's plane.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Registration:
    """x, y: the coils' centre in the workspace, m.  rotation: of the coils' x axis, counter-clockwise, rad.

    magnet_reversed: the magnet's north is at end B, so the robot needs every field the other way round.
    """

    x: float = 0.0
    y: float = 0.0
    rotation: float = 0.0
    magnet_reversed: bool = False

    def __post_init__(self) -> None:
        for name, unit in (("x", "m"), ("y", "m"), ("rotation", "rad")):
            value = getattr(self, name)
            if not math.isfinite(value):
                raise ValueError(
                    f"the coils' registration: {name} must be a finite number of {unit}, got {value}"
                )

    @property
    def frames_coincide(self) -> bool:
        """The coils' frame is the workspace's: nothing has to be turned or moved."""
        return self.x == 0.0 and self.y == 0.0 and self.rotation == 0.0

    def to_coils(self, points_workspace: Floats) -> Floats:
        """Points (n, 3) m of the workspace in the coils' frame."""
        return (points_workspace - self._origin) @ self._turn

    def to_workspace(self, points_coils: Floats) -> Floats:
        """Points (..., 3) m of the coils' frame in the workspace."""
        return points_coils @ self._turn.T + self._origin

    def turned(self, per_ampere_coils: Floats) -> Floats:
        """Fields (..., 3, m) of the coils' frame, a component a row, with the workspace's components."""
        return self._turn @ per_ampere_coils

    @property
    def _origin(self) -> Floats:
        return np.array([self.x, self.y, 0.0])

    @property
    def _turn(self) -> Floats:
        """R (3, 3): from the coils' components to the workspace's."""
        cosine, sine = math.cos(self.rotation), math.sin(self.rotation)
        return np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])


COINCIDENT = Registration()
"""The workspace's frame is the coils', and the magnet's north is at end A."""
