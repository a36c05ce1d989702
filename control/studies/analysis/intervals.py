"""A mean and how far it can be trusted."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import special

LEVEL = 0.95
"""Confidence of every interval in an analysis."""
NAN = float("nan")


@dataclass(frozen=True, slots=True)
class Interval:
    """An estimate and the interval that holds the true value with `LEVEL`; low and high are NaN where there is none."""

    value: float
    low: float = NAN
    high: float = NAN

    @property
    def known(self) -> bool:
        return math.isfinite(self.low) and math.isfinite(self.high)

    @property
    def half_width(self) -> float:
        return 0.5 * (self.high - self.low)

    def holds(self, value: float) -> bool:
        return self.low <= value <= self.high

    def scaled(self, factor: float) -> Interval:
        return Interval(self.value * factor, self.low * factor, self.high * factor)


NOTHING = Interval(NAN)


def finite(values: ArrayLike) -> NDArray[np.float64]:
    numbers = np.asarray(values, dtype=float)
    return numbers[np.isfinite(numbers)]


def t_quantile(freedom: float, level: float = LEVEL) -> float:
    """Half the width of a two-sided interval of Student's t, in standard errors."""
    return float(special.stdtrit(freedom, 0.5 + 0.5 * level))


def mean_interval(values: ArrayLike) -> Interval:
    """The mean with Student's interval; one value alone has none."""
    return mean_of_means([finite(values)])


def mean_of_means(groups: Sequence[NDArray[np.float64]]) -> Interval:
    """The mean of the groups' means, each group counting alike; a group without values is left out."""
    filled = [group for group in groups if len(group)]
    if not filled:
        return NOTHING
    value, error, freedom = moments(filled)
    if not math.isfinite(error):
        return Interval(value)
    reach = t_quantile(freedom) * error
    return Interval(value, value - reach, value + reach)


def moments(groups: Sequence[NDArray[np.float64]]) -> tuple[float, float, float]:
    """The mean of the means of groups that all have values, its standard error, and the freedom by Welch and
    Satterthwaite. The error is NaN where a group has one value only, and 0 where no group's values differ.
    """
    value = float(np.mean([np.mean(group) for group in groups]))
    if min(len(group) for group in groups) < 2:
        return value, NAN, 1.0
    shares = np.array(
        [np.var(group, ddof=1) / len(group) if np.ptp(group) > 0.0 else 0.0 for group in groups]
    )
    freedoms = np.array([len(group) - 1 for group in groups])
    total = float(np.sum(shares))
    if not total > 0.0:
        return value, 0.0, 1.0
    freedom = total**2 / float(np.sum(shares**2 / freedoms))
    return value, math.sqrt(total) / len(groups), freedom
