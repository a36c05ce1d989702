"""Which axis of scattered points (a Latin hypercube, a search) matters how much."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from control.studies.analysis.intervals import NAN
from control.studies.analysis.samples import Samples

Array = NDArray[np.float64]
BINS = 5
"""Parts with equally many points into which a numeric axis is cut; a curved effect shows in them, not in a rank
correlation."""
FEWEST_IN_A_BIN = 2


@dataclass(frozen=True, slots=True)
class Influence:
    """rank_correlation: Spearman's of axis and metric (NaN for words).  p_monotone: its p.
    share: epsilon squared of Kruskal and Wallis over the axis' bins (or words), bent effects included.  p: its p.
    points: sets with finished runs.
    """

    axis: str
    rank_correlation: float
    p_monotone: float
    share: float
    p: float
    points: int


def screening(samples: Samples) -> tuple[Influence, ...]:
    """Of the sets' means, so that a point that was measured often counts once; the strongest first."""
    groups = samples.groups()
    measured = [place for place, group in enumerate(groups) if len(group)]
    part = samples.chosen(measured)
    means = np.array([groups[place].mean() for place in measured])
    found = [_influence(part, axis, means) for axis in part.varied()] if len(means) > 2 else []
    return tuple(sorted(found, key=lambda one: -np.nan_to_num(one.share, nan=-1.0)))


def _influence(samples: Samples, axis: str, means: Array) -> Influence:
    rank, p_monotone = NAN, NAN
    if samples.numeric(axis) and np.ptp(means) > 0.0:
        found = stats.spearmanr(samples.numbers(axis), means)
        rank, p_monotone = (float(one) for one in found)  # pyright: ignore[reportArgumentType]
    share, p = _kruskal(_bins(samples, axis), means)
    return Influence(axis, rank, p_monotone, share, p, len(means))


def _bins(samples: Samples, axis: str) -> NDArray[np.int64]:
    """Part in which each set lies; words and few levels are their own parts."""
    levels = samples.levels(axis)
    if not samples.numeric(axis) or len(levels) <= BINS:
        return np.array([levels.index(value) for value in samples.column(axis)], dtype=np.int64)
    numbers = samples.numbers(axis)
    edges = np.quantile(numbers, np.linspace(0.0, 1.0, BINS + 1)[1:-1])
    return np.searchsorted(edges, numbers, side="right").astype(np.int64)


def _kruskal(bins: NDArray[np.int64], means: Array) -> tuple[float, float]:
    parts = [means[bins == one] for one in np.unique(bins)]
    parts = [part for part in parts if len(part) >= FEWEST_IN_A_BIN]
    count = sum(len(part) for part in parts)
    if len(parts) < 2 or count <= len(parts) or not np.ptp(np.concatenate(parts)) > 0.0:
        return NAN, NAN
    found = stats.kruskal(*parts)
    excess = (float(found.statistic) - len(parts) + 1) / (count - len(parts))
    return max(excess, 0.0), float(found.pvalue)
