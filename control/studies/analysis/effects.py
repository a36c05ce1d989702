"""Which axis of a grid matters how much: analysis of variance with the interactions of two axes."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from control.studies.analysis.intervals import Interval
from control.studies.analysis.linear_model import Codes, Term, basis, explained, levels
from control.studies.analysis.samples import MOST_LEVELS, Samples
from control.studies.analysis.shares import chance, share

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Effect:
    """axes: one, or two for an interaction.  share: eta squared, the share of all variance that goes with it; its
    interval, like p, supposes that all sets scatter alike.  p: chance of as much without any effect; NaN: cannot be
    tested.  freedom: degrees.  swing: largest less smallest mean over its levels, in the metric's unit.
    """

    axes: tuple[str, ...]
    share: Interval
    p: float
    freedom: int
    swing: float


@dataclass(frozen=True, slots=True)
class Effects:
    """effects: the largest share first.  noise: share of variance between runs of the same set, with what interactions
    of three axes and more explain.
    """

    effects: tuple[Effect, ...]
    noise: float
    runs: int


def effects(samples: Samples) -> Effects | None:
    """Type II sums of squares: each term beside all that do not contain it. None where there is nothing to compare."""
    part = samples.chosen([place for place, group in enumerate(samples.groups()) if len(group)])
    factors = [axis for axis in part.varied() if len(part.levels(axis)) <= MOST_LEVELS]
    groups = part.groups()
    if not factors or not float(np.ptp(np.concatenate(groups))) > 0.0:
        return None
    design = _Design.of([_codes(part, axis) for axis in factors], groups)
    rows = [
        _effect(design, at, tuple(factors[factor] for factor in term))
        for at, term in enumerate(design.terms)
        if design.freedoms[at] > 0
    ]
    rows.sort(key=lambda row: -row.share.value)
    return Effects(tuple(rows), design.left / design.total, design.runs)


def _effect(design: _Design, at: int, axes: tuple[str, ...]) -> Effect:
    freedoms = design.freedoms[at], design.runs - design.full.shape[1]
    sums = design.gained(at), design.left, design.total
    return Effect(
        axes, share(*sums, freedoms), chance(*sums, freedoms), freedoms[0], _swing(design, design.terms[at])
    )


@dataclass(frozen=True, slots=True)
class _Design:
    """means, counts: (sets,) of the runs.  total: sum of squares.  full: basis of all terms.
    pairs: for each term the bases with and without it.
    """

    codes: Sequence[Codes]
    means: Array
    counts: Array
    total: float
    terms: Sequence[Term]
    full: Array
    pairs: Sequence[tuple[Array, Array]]

    @classmethod
    def of(cls, codes: Sequence[Codes], groups: Sequence[Array]) -> _Design:
        values = np.concatenate(groups)
        means = np.array([group.mean() for group in groups]) - values.mean()
        counts = np.array([len(group) for group in groups], dtype=float)
        terms = _terms(len(codes))
        pairs = []
        for term in terms:
            without = [other for other in terms if not set(term) <= set(other)]
            pairs.append((basis(codes, counts, [*without, term]), basis(codes, counts, without)))
        total = float(np.sum((values - values.mean()) ** 2))
        return cls(codes, means, counts, total, terms, basis(codes, counts, terms), pairs)

    @property
    def runs(self) -> int:
        return int(self.counts.sum())

    @property
    def freedoms(self) -> list[int]:
        return [one.shape[1] - other.shape[1] for one, other in self.pairs]

    @property
    def left(self) -> float:
        return max(self.total - explained(self.full, self.counts, self.means), 0.0)

    def gained(self, at: int) -> float:
        one, other = (explained(columns, self.counts, self.means) for columns in self.pairs[at])
        return max(one - other, 0.0)


def _terms(factors: int) -> list[Term]:
    return [(one,) for one in range(factors)] + list(itertools.combinations(range(factors), 2))


def _codes(samples: Samples, axis: str) -> Codes:
    """Level of each set."""
    at = {level: code for code, level in enumerate(samples.levels(axis))}
    return np.array([at[value] for value in samples.column(axis)], dtype=np.int64)


def _swing(design: _Design, term: Term) -> float:
    """Of the means at the term's levels; of an interaction, of what the two main effects leave."""
    rest = design.means
    if len(term) > 1:
        for factor in term:
            rest = rest - _level_means(design, rest, (factor,))[design.codes[factor]]
    at_levels = _level_means(design, rest, term)
    return float(np.max(at_levels) - np.min(at_levels))


def _level_means(design: _Design, means: Array, term: Term) -> Array:
    code = levels(design.codes, term)
    return np.bincount(code, weights=design.counts * means) / np.bincount(code, weights=design.counts)
