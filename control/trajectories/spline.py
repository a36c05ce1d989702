"""A smooth curve through points, known by the length walked along it."""

from __future__ import annotations

import bisect
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from control.trajectories.pieces import Point

CENTRIPETAL = 0.5
"""Knots at the square root of the distances: no loops between points that are unevenly spaced."""
SUBDIVISIONS = 64
"""Pieces of the second curve for each one of the first: its speed is then constant to a thousandth."""
MOST_PIECES = 8000
"""Of the second curve: of thousands of points, close together as they are, each needs fewer."""
NODES, WEIGHTS = np.polynomial.legendre.leggauss(8)


class Spline:
    """The cubic spline through the points, laid anew through knots at their lengths along it."""

    def __init__(self, points: Sequence[Point], *, closed: bool) -> None:
        """points: m, at least two (three different ones when closed, the first repeated as the last)."""
        corners = np.array(points, dtype=float)
        chords = np.hypot(*np.diff(corners, axis=0).T)
        knots = np.concatenate([[0.0], np.cumsum(chords**CENTRIPETAL)])
        ends = "periodic" if closed else "natural"
        curve = CubicSpline(knots, corners, bc_type=ends)
        fine = np.unique(np.concatenate([_between(knots), knots]))
        lengths = np.concatenate([[0.0], np.cumsum(_lengths(curve, fine))])
        places = curve(fine)
        if closed:
            places[-1] = places[0]
        again = CubicSpline(lengths, places, bc_type=ends)
        self._starts: list[float] = lengths[:-1].tolist()
        self._cubics: list[list[float]] = again.c.transpose(1, 2, 0).reshape(len(fine) - 1, 8).tolist()
        self.length = float(lengths[-1])

    def at(self, distance: float) -> Point:
        """The point after `distance` (m, 0 to the whole length) along the curve."""
        index = max(0, bisect.bisect_right(self._starts, distance) - 1)
        s = distance - self._starts[index]
        x3, x2, x1, x0, y3, y2, y1, y0 = self._cubics[index]
        return ((x3 * s + x2) * s + x1) * s + x0, ((y3 * s + y2) * s + y1) * s + y0


def _between(knots: NDArray[np.float64]) -> NDArray[np.float64]:
    count = max(2, min(SUBDIVISIONS, MOST_PIECES // len(knots)))
    shares = np.arange(1, count) / count
    return (knots[:-1, None] + np.diff(knots)[:, None] * shares).ravel()


def _lengths(curve: CubicSpline, knots: NDArray[np.float64]) -> NDArray[np.float64]:
    """Lengths of the curve between neighbouring knots, by Gauss's quadrature of its speed, m."""
    half = 0.5 * np.diff(knots)[:, None]
    at = knots[:-1, None] + half * (1.0 + NODES)
    slopes = curve(at, 1)
    return (half * WEIGHTS * np.hypot(slopes[..., 0], slopes[..., 1])).sum(axis=1)
