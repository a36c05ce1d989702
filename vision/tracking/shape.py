"""A blob's shape by its moments, and the rectangle that has the same."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from cv2.typing import MatLike

EDGE_SPREAD = 0.57
"""What the edge's blur adds to either second moment, px^2: 0.7 px of lens, and the pixel itself."""

LEAST_SPREAD = 1e-9
"""A blob is taken to have at least this second moment, px^2."""


@dataclass(frozen=True, slots=True)
class Ellipse:
    """centre (u, v; px), principal second moments (px^2), direction of the long one (rad in [0, pi), u to v)."""

    u: float
    v: float
    long: float
    short: float
    axis: float

    @classmethod
    def of(cls, moments: Mapping[str, float]) -> Ellipse:
        """Of OpenCV's moments with a mass above 0."""
        mass = moments["m00"]
        uu, uv, vv = moments["mu20"] / mass, moments["mu11"] / mass, moments["mu02"] / mass
        mean, spread = 0.5 * (uu + vv), math.hypot(0.5 * (uu - vv), uv)
        axis = 0.5 * math.atan2(2.0 * uv, uu - vv) % math.pi
        return cls(moments["m10"] / mass, moments["m01"] / mass, mean + spread, mean - spread, axis)

    @property
    def elongation(self) -> float:
        """Long over short radius of gyration; finite, and 0 for what is no shape at all."""
        return math.sqrt(max(self.long, 0.0) / max(self.short, LEAST_SPREAD))

    @property
    def half_sides(self) -> tuple[float, float]:
        """Half length and half width of the rectangle with these moments, px: a side s has s^2/12."""
        return (
            math.sqrt(3.0 * max(self.long - EDGE_SPREAD, 0.0)),
            math.sqrt(3.0 * max(self.short - EDGE_SPREAD, 0.0)),
        )

    def corners(self, left: float, top: float) -> tuple[tuple[float, float], ...]:
        """Of that rectangle, in order round it, px, when the moments' origin is at (left, top)."""
        u, v, c, s = self.u + left, self.v + top, math.cos(self.axis), math.sin(self.axis)
        half, side = self.half_sides
        lu, lv, su, sv = half * c, half * s, -side * s, side * c
        return (
            (u + lu + su, v + lv + sv),
            (u + lu - su, v + lv - sv),
            (u - lu - su, v - lv - sv),
            (u - lu + su, v - lv + sv),
        )

    def cover(self, height: int, width: int) -> MatLike:
        """How much of each pixel (height, width) that rectangle covers, 0..1 float32."""
        half, side = self.half_sides
        du = (np.arange(width, dtype=np.float32) - np.float32(self.u))[None, :]
        dv = (np.arange(height, dtype=np.float32) - np.float32(self.v))[:, None]
        c, s = np.float32(math.cos(self.axis)), np.float32(math.sin(self.axis))
        along = np.clip(np.float32(half + 0.5) - np.abs(c * du + s * dv), 0.0, 1.0)
        return along * np.clip(np.float32(side + 0.5) - np.abs(c * dv - s * du), 0.0, 1.0)
