"""A Weibull distribution by maximum likelihood, with exact intervals and the test of its goodness.

The logarithm of a Weibull variable has a location and a scale, so the estimates' relative errors and the statistics
of Anderson and Darling and of Kolmogorov and Smirnov, all with estimated parameters, have distributions that depend
on the number of values alone (Thoman, Bain, Antle 1969; Stephens 1977). They are drawn once for each number.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from control.studies.analysis.intervals import LEVEL, Interval, finite

Array = NDArray[np.float64]
FEWEST = 8
"""Runs below which no distribution is fitted: its shape would be anything. A choice."""
DRAWS = 4000
DRAWN_NUMBERS = 800_000
"""At most so many samples, of at most so many numbers in all: the Monte Carlo's memory and time."""
ITERATIONS = 60
LARGEST_STEP = 1.0
"""Of ln(shape) in one step of Newton's method."""
SETTLED = 1e-12
SEED = 1951
"""Of the Monte Carlo, so that a table always gives the same report (the year of Weibull's paper)."""


@dataclass(frozen=True, slots=True)
class Weibull:
    """F(x) = 1 - exp(-((x - location) / scale)^shape).  likelihood: natural logarithm of it at the estimate."""

    shape: float
    scale: float
    location: float
    likelihood: float

    def cumulative(self, x: ArrayLike) -> Array:
        return -np.expm1(-(self._reduced(x) ** self.shape))

    def density(self, x: ArrayLike) -> Array:
        z = self._reduced(x)
        with np.errstate(divide="ignore", invalid="ignore"):
            return self.shape / self.scale * z ** (self.shape - 1.0) * np.exp(-(z**self.shape))

    def _reduced(self, x: ArrayLike) -> Array:
        return np.maximum((np.asarray(x, dtype=float) - self.location) / self.scale, 0.0)


@dataclass(frozen=True, slots=True)
class WeibullFit:
    """shape, scale: with exact intervals.  p_anderson, p_kolmogorov: chance of a worse fit if it is a Weibull.
    runs: how many values.
    """

    law: Weibull
    shape: Interval
    scale: Interval
    p_anderson: float
    p_kolmogorov: float
    runs: int


def fit(values: ArrayLike) -> WeibullFit | None:
    """With the location at 0. values: positive ones count; None for fewer than FEWEST or no scatter."""
    x = positive(values)
    if x is None:
        return None
    shape, scale = (float(one[0]) for one in estimates(x[None, :]))
    law = Weibull(shape, scale, 0.0, float(likelihood(x[None, :], np.array([shape]), np.array([scale]))[0]))
    null = _null(len(x))
    anderson, kolmogorov = statistics(law.cumulative(x)[None, :])
    return WeibullFit(
        law,
        Interval(shape, *(shape / edge for edge in reversed(_edges(null.shape)))),
        Interval(scale, *(scale * float(np.exp(-edge / shape)) for edge in reversed(_edges(null.scale)))),
        chance(null.anderson, float(anderson[0])),
        chance(null.kolmogorov, float(kolmogorov[0])),
        len(x),
    )


def positive(values: ArrayLike) -> Array | None:
    """Ascending; None where nothing can be fitted."""
    x = np.sort(finite(values))
    x = x[x > 0.0]
    return x if len(x) >= FEWEST and x[-1] > x[0] else None


def estimates(x: Array) -> tuple[Array, Array]:
    """x: (m, n) positive. Shape and scale (m,) by maximum likelihood, location 0.

    Newton's method in ln(shape) on  sum(x^k ln x) / sum(x^k) - 1/k - mean(ln x) = 0, which has one root.
    """
    logs = np.log(x)
    top = logs.max(axis=1, keepdims=True)
    y = logs - top
    mean = y.mean(axis=1)
    shape = np.pi / (np.sqrt(6.0) * np.maximum(y.std(axis=1), np.finfo(float).tiny))
    for _ in range(ITERATIONS):
        weights = np.exp(shape[:, None] * y)
        total = weights.sum(axis=1)
        first = (weights * y).sum(axis=1) / total
        second = (weights * y * y).sum(axis=1) / total
        off = first - 1.0 / shape - mean
        step = off / (shape * (second - first**2) + 1.0 / shape)
        shape = shape * np.exp(-np.clip(step, -LARGEST_STEP, LARGEST_STEP))
        if np.max(np.abs(step)) < SETTLED:
            break
    scale = np.exp(top[:, 0] + np.log(np.exp(shape[:, None] * y).mean(axis=1)) / shape)
    return shape, scale


def likelihood(x: Array, shape: Array, scale: Array) -> Array:
    """x: (m, n) above the location. Natural logarithm of the likelihood, (m,)."""
    z = np.log(x) - np.log(scale)[:, None]
    each = np.log(shape / scale)[:, None] + (shape[:, None] - 1.0) * z - np.exp(shape[:, None] * z)
    return each.sum(axis=1)


def statistics(cumulative: Array) -> tuple[Array, Array]:
    """cumulative: (m, n) the law's F at the ascending values. Anderson and Darling's A^2, Kolmogorov's D; (m,)."""
    count = cumulative.shape[1]
    tiny = np.finfo(float).eps
    u = np.clip(cumulative, tiny, 1.0 - tiny)
    rank = np.arange(1, count + 1)
    anderson = -count - np.sum((2 * rank - 1) / count * (np.log(u) + np.log1p(-u[:, ::-1])), axis=1)
    kolmogorov = np.maximum(np.max(rank / count - u, axis=1), np.max(u - (rank - 1) / count, axis=1))
    return anderson, kolmogorov


def chance(null: Array, seen: float) -> float:
    """How often the null's draws are at least as far off as what was seen; never 0."""
    return float((1 + np.sum(null >= seen)) / (1 + len(null)))


@dataclass(frozen=True, slots=True)
class _Null:
    """Draws with shape 1 and scale 1: estimate of the shape, shape x ln(scale), and the two statistics."""

    shape: Array
    scale: Array
    anderson: Array
    kolmogorov: Array


@lru_cache(maxsize=16)
def _null(count: int) -> _Null:
    draws = max(min(DRAWS, DRAWN_NUMBERS // count), 200)
    x = np.sort(np.random.default_rng((SEED, count)).exponential(size=(draws, count)), axis=1)
    shape, scale = estimates(x)
    cumulative = -np.expm1(-((x / scale[:, None]) ** shape[:, None]))
    return _Null(shape, shape * np.log(scale), *statistics(cumulative))


def _edges(draws: Array) -> tuple[float, float]:
    low, high = np.quantile(draws, (0.5 - 0.5 * LEVEL, 0.5 + 0.5 * LEVEL))
    return float(low), float(high)
