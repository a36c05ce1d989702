"""A Weibull distribution whose location is free too.

Its likelihood grows without bound when the location comes up to the smallest value with a shape below 1; so the
shape is kept at 1 and above, where the estimate is the usual one (Smith 1985).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from control.studies.analysis.weibull import (
    SEED,
    Weibull,
    chance,
    estimates,
    likelihood,
    positive,
    statistics,
)

Array = NDArray[np.float64]
NEAREST, FARTHEST = -4.0, 1.5
"""Locations tried lie 10^NEAREST to 10^FARTHEST spans (largest less smallest value) below the smallest value."""
COARSE = 23
FINE = 15
"""Locations tried: over the whole range, then around the best of them."""
DRAWS = 199
"""Samples of the parametric bootstrap for the goodness; p has a standard error of 0.015 at 0.05."""


@dataclass(frozen=True, slots=True)
class LocatedFit:
    """p_anderson: chance of a worse fit if it is such a law, by a parametric bootstrap.
    far: the location wants to be farther below than was tried; the law is then all but a Gumbel distribution.
    """

    law: Weibull
    p_anderson: float
    far: bool


def fit_located(values: ArrayLike) -> LocatedFit | None:
    """None where nothing can be fitted."""
    x = positive(values)
    if x is None:
        return None
    location, shape, scale, best = (one[0] for one in _estimates(x[None, :]))
    law = Weibull(float(shape), float(scale), float(location), float(best))
    seen, _ = statistics(law.cumulative(x)[None, :])
    return LocatedFit(
        law,
        chance(_null(law, len(x)), float(seen[0])),
        bool(x[0] - location >= 0.99 * 10.0**FARTHEST * (x[-1] - x[0])),
    )


def _null(law: Weibull, count: int) -> Array:
    """Anderson and Darling's A^2 of samples of the law, each with its own estimates."""
    draws = np.random.default_rng((SEED, count)).weibull(law.shape, size=(DRAWS, count))
    x = np.sort(draws, axis=1)
    location, shape, scale, _ = _estimates(x)
    reduced = (x - location[:, None]) / scale[:, None]
    return statistics(-np.expm1(-(reduced ** shape[:, None])))[0]


def _estimates(x: Array) -> tuple[Array, Array, Array, Array]:
    """x: (m, n) ascending. Location, shape, scale, likelihood of the best location for each row."""
    coarse = np.linspace(NEAREST, FARTHEST, COARSE)
    first = _best(x, np.tile(coarse, (len(x), 1)))
    step = coarse[1] - coarse[0]
    around = first[:, None] + np.linspace(-step, step, FINE)
    found = _best(x, np.minimum(around, FARTHEST))
    return _at(x, found)


def _best(x: Array, exponents: Array) -> Array:
    """The exponent (m,) with the highest likelihood, of those offered for each row (m, offers)."""
    offers = np.stack([_at(x, column)[3] for column in exponents.T], axis=1)
    return exponents[np.arange(len(x)), np.argmax(offers, axis=1)]


def _at(x: Array, exponent: Array) -> tuple[Array, Array, Array, Array]:
    location = x[:, 0] - 10.0**exponent * (x[:, -1] - x[:, 0])
    above = x - location[:, None]
    shape, scale = estimates(above)
    flat = shape < 1.0
    shape = np.where(flat, 1.0, shape)
    scale = np.where(flat, above.mean(axis=1), scale)
    return location, shape, scale, likelihood(above, shape, scale)
