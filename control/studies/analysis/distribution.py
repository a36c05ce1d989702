"""How single runs of one set scatter: moments, the Weibull law, and whether another law fits better."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import stats

from control.studies.analysis.intervals import LEVEL, NAN, Interval, finite, mean_interval
from control.studies.analysis.weibull import SEED, WeibullFit, fit, positive
from control.studies.analysis.weibull_location import LocatedFit, fit_located

Array = NDArray[np.float64]
RESAMPLES = 2000
"""Of the bootstrap for the deviation."""
REFUSED = 0.05
"""A law is called refused where its test's p is below this."""


@dataclass(frozen=True, slots=True)
class Distribution:
    """values: the finished runs', ascending.  mean: with Student's interval.  deviation: of single runs, by BCa
    bootstrap.  weibull, located: None for too few runs.  preference: Akaike's criterion (corrected for few values)
    of each law less that of the best one; 0 is best, more than 4 clearly worse.
    """

    values: Array
    mean: Interval
    deviation: Interval
    skewness: float
    weibull: WeibullFit | None
    located: LocatedFit | None
    preference: dict[str, float]

    @property
    def variance(self) -> Interval:
        low, high = self.deviation.low, self.deviation.high
        return Interval(self.deviation.value**2, low * low, high * high)


def describe(values: ArrayLike) -> Distribution:
    """values: a metric of one set's finished runs."""
    x = np.sort(finite(values))
    weibull, located = fit(x), fit_located(x)
    return Distribution(
        x,
        mean_interval(x),
        _deviation(x),
        _skewness(x),
        weibull,
        located,
        _preference(x, weibull, located),
    )


def _skewness(x: Array) -> float:
    return float(stats.skew(x)) if len(x) > 2 and x[-1] > x[0] else NAN


def _deviation(x: Array) -> Interval:
    if len(x) < 2:
        return Interval(NAN)
    value = float(np.std(x, ddof=1))
    if positive(x) is None:
        return Interval(value)
    found = stats.bootstrap(
        (x,), _spread, n_resamples=RESAMPLES, confidence_level=LEVEL, method="BCa",
        rng=np.random.default_rng((SEED, len(x))),
    ).confidence_interval  # fmt: skip
    return Interval(value, float(found.low), float(found.high))


def _spread(x: Array, axis: int = -1) -> Array:
    return np.std(x, ddof=1, axis=axis)


def _preference(x: Array, weibull: WeibullFit | None, located: LocatedFit | None) -> dict[str, float]:
    if weibull is None or located is None:
        return {}
    x = x[x > 0.0]
    logs = np.log(x)
    criteria = {
        "Weibull": _akaike(weibull.law.likelihood, 2, len(x)),
        "Weibull with a location": _akaike(located.law.likelihood, 3, len(x)),
        "normal": _akaike(_normal_likelihood(x), 2, len(x)),
        "log-normal": _akaike(_normal_likelihood(logs) - float(np.sum(logs)), 2, len(x)),
    }
    least = min(criteria.values())
    return {name: value - least for name, value in criteria.items()}


def _normal_likelihood(x: Array) -> float:
    return -0.5 * len(x) * (math.log(2.0 * math.pi * float(np.var(x))) + 1.0)


def _akaike(likelihood: float, parameters: int, count: int) -> float:
    return 2.0 * (parameters - likelihood) + 2.0 * parameters * (parameters + 1) / (count - parameters - 1)
