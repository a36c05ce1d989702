"""The coils' field per ampere on the plate, tabulated once and read back in plain floats.

Three pairs that stand centred on the three axes are mirror images of themselves in the plate's plane
(z = 0), so there the x and y pairs make no vertical field and the z pair makes no horizontal one. Five of
the nine elements of K(p) are left; the map holds those.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

PlaneElements = tuple[float, float, float, float, float]
"""The elements of K on the plate that are not zero: (Kxx, Kxy, Kyx, Kyy, Kzz), T/A.

Kxy is the x component that the y pair makes."""

SPACING = 0.002
"""Grid step, m: bilinear error of the default rig under 0.02 % of the field (tests hold it under 0.1 %)."""


class FieldMap:
    """Bilinear interpolation of K(p) over a square around the coil centre.

    sample: points (n, 3) m -> K (n, 3, 3) T/A, rows = field components, columns = pairs.
    half_size: half the side of the square, m; a point outside is read at the nearest point of the edge.
    """

    def __init__(self, sample: Callable[[NDArray[np.float64]], NDArray[np.float64]], half_size: float):
        steps = 2 * math.ceil(half_size / SPACING)
        self.half_size = half_size
        self.axis: NDArray[np.float64] = np.linspace(-half_size, half_size, steps + 1)
        self.nodes: NDArray[np.float64] = _sample_square(sample, self.axis)
        self._steps = steps
        self._inverse_spacing = 0.5 * steps / half_size
        self._cells: list[list[float]] = _cell_coefficients(self.nodes)

    def elements(self, x: float, y: float) -> PlaneElements:
        """The non-zero elements of K at (x, y) m; about a microsecond, so the loop may ask at every step."""
        half = self.half_size
        if not (-half <= x <= half and -half <= y <= half):
            x, y = _nearest_inside(x, half), _nearest_inside(y, half)
        last = self._steps - 1
        u = (x + half) * self._inverse_spacing
        v = (y + half) * self._inverse_spacing
        column = min(int(u), last)
        row = min(int(v), last)
        u -= column
        v -= row
        w = u * v
        a, au, av, aw, b, bu, bv, bw, c, cu, cv, cw, d, du, dv, dw, e, eu, ev, ew = self._cells[
            column * self._steps + row
        ]
        return (
            a + au * u + av * v + aw * w,
            b + bu * u + bv * v + bw * w,
            c + cu * u + cv * v + cw * w,
            d + du * u + dv * v + dw * w,
            e + eu * u + ev * v + ew * w,
        )


def _nearest_inside(value: float, half: float) -> float:
    if not math.isfinite(value):
        raise ValueError(f"the field map needs a finite position in m, got {value}")
    return min(max(value, -half), half)


def _sample_square(
    sample: Callable[[NDArray[np.float64]], NDArray[np.float64]], axis: NDArray[np.float64]
) -> NDArray[np.float64]:
    """K (n, n, 3, 3) on the nodes of the square, first index x, second y."""
    x, y = np.meshgrid(axis, axis, indexing="ij")
    points = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    return sample(points).reshape(axis.size, axis.size, 3, 3)


def _cell_coefficients(nodes: NDArray[np.float64]) -> list[list[float]]:
    """For each cell and each of the five elements: value, slope in u, slope in v, twist."""
    values = nodes[:, :, [0, 0, 1, 1, 2], [0, 1, 0, 1, 2]]
    low, right, up, far = values[:-1, :-1], values[1:, :-1], values[:-1, 1:], values[1:, 1:]
    coefficients = np.stack([low, right - low, up - low, far - right - up + low], axis=-1)
    return coefficients.reshape(-1, 20).tolist()
