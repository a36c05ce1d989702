"""A smooth line through means of known scatter: the natural cubic smoothing spline, as a linear operator.

Green and Silverman, Nonparametric Regression and Generalized Linear Models, 1994, chapter 2: at the knots the line is
(W + lambda K)^-1 W y, and between them the natural cubic spline. How smooth is chosen by Mallows' Cp, for the scatter
of the means is known from the repeats.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BarycentricInterpolator, CubicSpline

Array = NDArray[np.float64]
SMOOTHNESSES = 10.0 ** np.arange(-6.0, 4.01, 0.25)
"""Tried, times the natural scale of the problem; 0 (through every mean) is tried too."""
FEWEST_SMOOTHED = 5
"""Knots; fewer are joined by the parabola or cubic through them: smoothing would bend them towards a straight line."""
FINE = 401
"""Points of the line over its whole range."""


@dataclass(frozen=True, slots=True)
class Smoother:
    """x: (fine,) places of the line.  operator: (fine, knots) from the means to the line."""

    x: Array
    operator: Array

    def line(self, means: Array) -> Array:
        """means: (..., knots). The line (..., fine)."""
        return means @ self.operator.T


def smoother(x: Array, means: Array, errors: Array) -> Smoother:
    """x: (k,) ascending, at least 3.  means, errors: (k,) means and their standard errors; if one is 0 or NaN, the line
    goes through every mean."""
    fine = np.linspace(x[0], x[-1], FINE)
    if len(x) < FEWEST_SMOOTHED:
        return Smoother(fine, BarycentricInterpolator(x, np.eye(len(x)))(fine))
    between = CubicSpline(x, np.eye(len(x)), axis=0, bc_type="natural")(fine)
    if not np.all(errors > 0.0):
        return Smoother(fine, between)
    weights = 1.0 / errors**2
    roughness = _roughness(x)
    scale = float(np.mean(weights)) / float(np.trace(roughness) / len(x))
    hats = [np.eye(len(x))]
    hats += [_hat(weights, share * scale * roughness) for share in SMOOTHNESSES]
    best = min(hats, key=lambda hat: _mallows(hat, means, weights))
    return Smoother(fine, between @ best)


def _hat(weights: Array, penalty: Array) -> Array:
    return np.asarray(np.linalg.solve(np.diag(weights) + penalty, np.diag(weights)), dtype=np.float64)


def _mallows(hat: Array, means: Array, weights: Array) -> float:
    """An unbiased estimate (but for a constant) of the line's squared error in units of the means' variance."""
    return float(np.sum(weights * (means - hat @ means) ** 2) + 2.0 * np.trace(hat))


def _roughness(x: Array) -> Array:
    """K with  f K f = integral of f''^2  for the natural spline f through its values at the knots."""
    h = np.diff(x)
    inner = len(x) - 2
    Q = np.zeros((len(x), inner))
    R = np.zeros((inner, inner))
    for j in range(inner):
        Q[j : j + 3, j] = 1.0 / h[j], -1.0 / h[j] - 1.0 / h[j + 1], 1.0 / h[j + 1]
        R[j, j] = (h[j] + h[j + 1]) / 3.0
        if j + 1 < inner:
            R[j, j + 1] = R[j + 1, j] = h[j + 1] / 6.0
    return np.asarray(Q @ np.linalg.solve(R, Q.T), dtype=np.float64)
