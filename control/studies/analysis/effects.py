"""Which axis of a grid matters how much: analysis of variance with the interactions of two axes."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from control.studies.analysis.intervals import LEVEL, NAN, Interval
from control.studies.analysis.linear_model import Codes, Term, basis, explained, levels
from control.studies.analysis.samples import MOST_LEVELS, Samples

Array = NDArray[np.float64]
RESAMPLES = 200
"""Of the runs within each set, for the intervals of the shares."""
SEED = 63


@dataclass(frozen=True, slots=True)
class Effect:
    """axes: one, or two for an interaction.  share: eta squared, the share of all variance that goes with it, with a
    bootstrap interval.  p: chance of as much without any effect.  freedom: degrees.
    swing: largest less smallest mean over its levels, in the metric's unit.
    """

    axes: tuple[str, ...]
    share: Interval
    p: float
    freedom: int
    swing: float


@dataclass(frozen=True, slots=True)
class Effects:
    """effects: the largest share first.  noise: share of variance between runs of the same set, with what interactions
    of three axes and more explain.  p_equal_scatter: Brown and Forsythe's test that all sets scatter alike; where it
    is small, the p of the effects are approximate.
    """

    effects: tuple[Effect, ...]
    noise: float
    p_equal_scatter: float
    runs: int


def effects(samples: Samples) -> Effects | None:
    """Type II sums of squares: each term beside all that do not contain it. None where there is nothing to compare."""
    part = samples.chosen([place for place, group in enumerate(samples.groups()) if len(group)])
    factors = [axis for axis in part.varied() if len(part.levels(axis)) <= MOST_LEVELS]
    groups = part.groups()
    if not factors or not float(np.ptp(np.concatenate(groups))) > 0.0:
        return None
    design = _Design.of([_codes(part, axis) for axis in factors], groups)
    found = design.analyse(*_moments(groups))
    drawn = design.analyse(*_resampled(groups)).shares
    rows = [
        Effect(
            tuple(factors[factor] for factor in term),
            _share(float(found.shares[at, 0]), drawn[at]),
            design.chance(found, at),
            design.freedoms[at],
            _swing(design, _means(groups), term),
        )
        for at, term in enumerate(design.terms)
        if design.freedoms[at] > 0
    ]
    rows.sort(key=lambda row: -row.share.value)
    return Effects(tuple(rows), float(found.left[0] / found.total[0]), _scatter(groups), design.runs)


@dataclass(frozen=True, slots=True)
class _Sums:
    """total, left: sums of squares (draws,).  shares: of each term, (terms, draws)."""

    total: Array
    left: Array
    shares: Array


@dataclass(frozen=True, slots=True)
class _Design:
    """counts: (sets,) runs.  full: basis of all terms.  pairs: for each term the bases with and without it."""

    codes: Sequence[Codes]
    counts: Array
    terms: Sequence[Term]
    full: Array
    pairs: Sequence[tuple[Array, Array]]

    @classmethod
    def of(cls, codes: Sequence[Codes], groups: Sequence[Array]) -> _Design:
        counts = np.array([len(group) for group in groups], dtype=float)
        terms = _terms(len(codes))
        pairs = []
        for term in terms:
            without = [other for other in terms if not set(term) <= set(other)]
            pairs.append((basis(codes, counts, [*without, term]), basis(codes, counts, without)))
        return cls(codes, counts, terms, basis(codes, counts, terms), pairs)

    @property
    def runs(self) -> int:
        return int(self.counts.sum())

    @property
    def freedoms(self) -> list[int]:
        return [one.shape[1] - other.shape[1] for one, other in self.pairs]

    def analyse(self, means: Array, within: Array) -> _Sums:
        """means: (sets, draws).  within: (draws,) sum of squares of the runs around their sets' means."""
        means = means - self.counts @ means / self.runs
        total = self.counts @ means**2 + within
        gained = [
            explained(one, self.counts, means) - explained(other, self.counts, means)
            for one, other in self.pairs
        ]
        left = total - explained(self.full, self.counts, means)
        return _Sums(total, left, np.maximum(gained, 0.0) / total)

    def chance(self, found: _Sums, at: int) -> float:
        """p of one term by Fisher's F."""
        freedom, rest = self.freedoms[at], self.runs - self.full.shape[1]
        left = float(found.left[0])
        if not (rest > 0 and left > 0.0):
            return NAN
        gained = float(found.shares[at, 0] * found.total[0])
        return float(stats.f.sf((gained / freedom) / (left / rest), freedom, rest))


def _means(groups: Sequence[Array]) -> Array:
    return np.array([group.mean() for group in groups])


def _moments(groups: Sequence[Array]) -> tuple[Array, Array]:
    """Means (sets, 1) and the sum of squares within the sets (1,)."""
    within = sum(float(np.sum((group - group.mean()) ** 2)) for group in groups)
    return _means(groups)[:, None], np.array([within])


def _resampled(groups: Sequence[Array]) -> tuple[Array, Array]:
    """Moments of runs drawn again within each set, (sets, draws) and (draws,); no draws where no set has two runs."""
    draws = RESAMPLES if max(len(group) for group in groups) > 1 else 0
    rng = np.random.default_rng(SEED)
    again = [group[rng.integers(len(group), size=(draws, len(group)))] for group in groups]
    means = np.array([runs.mean(axis=1) for runs in again])
    within = sum(np.sum((runs - runs.mean(axis=1, keepdims=True)) ** 2, axis=1) for runs in again)
    return means, np.asarray(within)


def _terms(factors: int) -> list[Term]:
    return [(one,) for one in range(factors)] + list(itertools.combinations(range(factors), 2))


def _codes(samples: Samples, axis: str) -> Codes:
    """Level of each set."""
    at = {level: code for code, level in enumerate(samples.levels(axis))}
    return np.array([at[value] for value in samples.column(axis)], dtype=np.int64)


def _share(value: float, drawn: Array) -> Interval:
    """The basic bootstrap: drawing again adds as much of the noise to a share as the runs themselves did."""
    if not len(drawn):
        return Interval(value)
    low, high = np.quantile(drawn, (0.5 - 0.5 * LEVEL, 0.5 + 0.5 * LEVEL))
    return Interval(
        value, max(min(2.0 * value - float(high), value), 0.0), min(max(2.0 * value - float(low), value), 1.0)
    )


def _swing(design: _Design, means: Array, term: Term) -> float:
    """Of the means at the term's levels; of an interaction, of what the two main effects leave."""
    rest = means
    if len(term) > 1:
        for factor in term:
            rest = rest - _level_means(design, rest, (factor,))[design.codes[factor]]
    at_levels = _level_means(design, rest, term)
    return float(np.max(at_levels) - np.min(at_levels))


def _level_means(design: _Design, means: Array, term: Term) -> Array:
    code = levels(design.codes, term)
    return np.bincount(code, weights=design.counts * means) / np.bincount(code, weights=design.counts)


def _scatter(groups: Sequence[Array]) -> float:
    scattered = [group for group in groups if len(group) > 1 and np.ptp(group) > 0.0]
    return float(stats.levene(*scattered, center="median").pvalue) if len(scattered) > 1 else NAN
