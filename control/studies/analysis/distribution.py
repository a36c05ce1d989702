"""How single runs of one set scatter: moments, the Weibull law, and whether another law fits better."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import special, stats

from control.studies.analysis.intervals import LEVEL, NAN, Interval, finite, mean_interval
from control.studies.analysis.weibull import FEWEST, WeibullFit, fit
from control.studies.analysis.weibull_location import LocatedFit, fit_located

Array = NDArray[np.float64]
REFUSED = 0.05
"""A law is called refused where its test's p is below this."""


@dataclass(frozen=True, slots=True)
class Distribution:
    """values: the finished runs', ascending.  mean: with Student's interval.  deviation: of single runs, with
    Bonett's interval.  weibull, located: None for too few runs.  preference: Akaike's criterion (corrected for few
    values) of each law less that of the best one; 0 is best, more than 4 clearly worse.
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
    """Bonett, Approximate confidence interval for standard deviation of nonnormal distributions, 2006."""
    if len(x) < 2:
        return Interval(NAN)
    count, value = len(x), float(np.std(x, ddof=1))
    if count < FEWEST or not x[-1] > x[0]:
        return Interval(value)
    middle = float(stats.trim_mean(x, 0.5 / math.sqrt(count - 4)))
    kurtosis = count * float(np.sum((x - middle) ** 4) / np.sum((x - x.mean()) ** 2) ** 2)
    quantile = float(special.ndtri(0.5 + 0.5 * LEVEL))
    few = count / (count - quantile)
    error = few * math.sqrt((kurtosis - (count - 3) / count) / (count - 1))
    low, high = (value * math.sqrt(few * math.exp(side * quantile * error)) for side in (-1.0, 1.0))
    return Interval(value, min(low, value), high)


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
