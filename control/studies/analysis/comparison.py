"""Which value of a categorical axis (a controller, a plant) lies below which, set by set."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from control.studies.analysis.intervals import LEVEL, NAN, Interval
from control.studies.analysis.samples import Samples

Array = NDArray[np.float64]
FEWEST = 2
"""Runs on either side; a difference of single runs has no interval."""


class Order(StrEnum):
    LOWER = "lower"
    HIGHER = "higher"
    OPEN = "cannot be told"


@dataclass(frozen=True, slots=True)
class Comparison:
    """one, other: values of the axis.  fixed: values of the other axes.  difference: mean of one less that of other,
    Welch's interval; runs that do not scatter leave nothing unsure.  p_welch, p_ranks: Welch's t and Mann and
    Whitney's test.
    effect: Hedges' g.  below: chance that a run of one has the smaller value, ties half.
    """

    axis: str
    one: Any
    other: Any
    fixed: Mapping[str, Any]
    means: tuple[float, float]
    difference: Interval
    p_welch: float
    p_ranks: float
    effect: float
    below: float
    runs: tuple[int, int]

    @property
    def order(self) -> Order:
        """By the interval of the difference."""
        if self.difference.high < 0.0:
            return Order.LOWER
        if self.difference.low > 0.0:
            return Order.HIGHER
        return Order.OPEN

    @property
    def ratio(self) -> float:
        """Mean of one over mean of other."""
        return self.means[0] / self.means[1] if self.means[1] else NAN

    @property
    def inverse_ratio(self) -> float:
        return self.means[1] / self.means[0] if self.means[0] else NAN


def compare(samples: Samples, axis: str) -> tuple[Comparison, ...]:
    """Every pair of the axis' values at every point of the other axes where both have finished runs."""
    at = samples.axes.index(axis)
    found: dict[tuple[Any, ...], dict[Any, Array]] = {}
    for point, group in zip(samples.points, samples.groups(), strict=True):
        if len(group):
            found.setdefault(point[:at] + point[at + 1 :], {})[point[at]] = group
    others = [name for name in samples.axes if name != axis]
    return tuple(
        pair(values[one], values[other], (axis, one, other, dict(zip(others, rest, strict=True))))
        for rest, values in found.items()
        for one, other in itertools.combinations(
            [level for level in samples.levels(axis) if level in values], 2
        )
    )


def pair(a: Array, b: Array, named: tuple[str, Any, Any, Mapping[str, Any]] = ("", "", "", {})) -> Comparison:
    """Two sets of finished runs, each with at least one. named: axis, one, other, fixed."""
    axis, one, other, fixed = named
    means = float(a.mean()), float(b.mean())
    repeated = min(len(a), len(b)) >= FEWEST
    scattered = repeated and (np.ptp(a) > 0.0 or np.ptp(b) > 0.0)
    difference = means[0] - means[1]
    return Comparison(
        axis, one, other, fixed, means,
        _difference(a, b) if scattered else Interval(difference, *([difference] * 2 if repeated else [])),
        _welch(a, b) if scattered else NAN,
        float(stats.mannwhitneyu(a, b).pvalue) if scattered else NAN,
        _hedges(a, b) if scattered else NAN,
        _below(a, b),
        (len(a), len(b)),
    )  # fmt: skip


def _welch(a: Array, b: Array) -> float:
    return float(stats.ttest_ind(a, b, equal_var=False)[1])  # pyright: ignore[reportArgumentType]


def _difference(a: Array, b: Array) -> Interval:
    found = stats.ttest_ind(a, b, equal_var=False).confidence_interval(LEVEL)
    return Interval(float(a.mean() - b.mean()), float(found.low), float(found.high))


def _hedges(a: Array, b: Array) -> float:
    """Difference of the means over the pooled deviation, corrected for few runs."""
    freedom = len(a) + len(b) - 2
    pooled = math.sqrt((np.var(a, ddof=1) * (len(a) - 1) + np.var(b, ddof=1) * (len(b) - 1)) / freedom)
    return float(a.mean() - b.mean()) / pooled * (1.0 - 3.0 / (4.0 * freedom - 1.0))


def _below(a: Array, b: Array) -> float:
    ordered = np.sort(b)
    above = len(b) - np.searchsorted(ordered, a, side="right")
    ties = np.searchsorted(ordered, a, side="right") - np.searchsorted(ordered, a, side="left")
    return float(np.mean(above + 0.5 * ties) / len(b))
