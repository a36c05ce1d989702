"""Whether runs grew worse or better while the study went on, whatever their set."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import special, stats

from control.studies.analysis.intervals import Interval, t_quantile
from control.studies.analysis.samples import Samples

FEWEST = 8
"""Runs with a set's mean to compare with; a choice."""
NOTICED = 0.01
"""p below which drift is reported as such: few enough false alarms for a check made at every study. A choice."""


@dataclass(frozen=True, slots=True)
class Drift:
    """slope: change of the metric from the first run to the last that finished, sets' means taken out, with Student's
    interval.  rank_correlation, p: Spearman's, of what is left with the place in the order, tested with the freedom
    that the sets' means leave.
    """

    slope: Interval
    rank_correlation: float
    p: float
    runs: int

    @property
    def noticed(self) -> bool:
        return self.p < NOTICED


def drift(samples: Samples, order: Sequence[int]) -> Drift | None:
    """order: indices of the plan as they were carried out. None where too few sets have repeats."""
    position = {index: place for place, index in enumerate(order)}
    where, left, ends = [], [], []
    for place in range(len(samples.points)):
        chosen = (samples.place == place) & np.isfinite(samples.value)
        chosen &= np.isin(samples.index, list(position))
        if np.sum(chosen) > 1:
            values = samples.value[chosen]
            at = np.array([position[int(index)] for index in samples.index[chosen]], dtype=float)
            where.append(at - at.mean())
            left.append(values - values.mean())
            ends += [at.min(), at.max()]
    if not left or sum(map(len, left)) - len(left) < FEWEST:
        return None
    return _found(np.concatenate(where), np.concatenate(left), len(left), float(np.ptp(ends)))


def _found(x: np.ndarray, y: np.ndarray, sets: int, span: float) -> Drift | None:
    """x, y: place in the order and metric, each less its set's mean.  span: from the first place to the last."""
    if not (np.ptp(x) > 0.0 and np.ptp(y) > 0.0):
        return None
    spread = float(x @ x)
    slope = float(x @ y) / spread
    freedom = len(y) - sets - 1
    error = np.sqrt(float(np.sum((y - slope * x) ** 2)) / freedom / spread)
    reach = t_quantile(freedom) * float(error)
    rank = float(stats.spearmanr(x, y)[0])  # pyright: ignore[reportArgumentType]
    return Drift(
        Interval(slope, slope - reach, slope + reach).scaled(span),
        rank,
        _chance(rank, freedom),
        len(y),
    )


def _chance(correlation: float, freedom: int) -> float:
    """p without any effect. Runs less their set's mean are not free: two of them are each other's mirror."""
    if abs(correlation) >= 1.0:
        return 0.0
    return 2.0 * float(special.stdtr(freedom, -abs(correlation) * np.sqrt(freedom / (1.0 - correlation**2))))
