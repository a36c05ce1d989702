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
    """The mean of the groups' means, each group counting alike; freedom by Welch and Satterthwaite.

    A group without values is left out; where a group has one value only, its scatter and so the interval is unknown.
    """
    filled = [group for group in groups if len(group)]
    if not filled:
        return NOTHING
    value = float(np.mean([np.mean(group) for group in filled]))
    if min(len(group) for group in filled) < 2:
        return Interval(value)
    shares = np.array([np.var(group, ddof=1) / len(group) for group in filled])
    freedoms = np.array([len(group) - 1 for group in filled])
    total = float(np.sum(shares))
    if not total > 0.0:
        return Interval(value, value, value)
    freedom = total**2 / float(np.sum(shares**2 / freedoms))
    reach = t_quantile(freedom) * math.sqrt(total) / len(filled)
    return Interval(value, value - reach, value + reach)
