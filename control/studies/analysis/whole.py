"""Everything that is said of a study: all analyses of one metric, each where the design allows it."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from control.studies.analysis.comparison import Comparison, compare
from control.studies.analysis.distribution import Distribution, describe
from control.studies.analysis.drift import Drift, drift
from control.studies.analysis.effects import Effects, effects
from control.studies.analysis.optimum import FEWEST_LEVELS, Optimum, optimum
from control.studies.analysis.samples import ME, Row, Samples, samples
from control.studies.analysis.screening import Influence, screening
from control.studies.analysis.sets import SetSummary, best, summarise

if TYPE_CHECKING:
    from control.studies.analysis.joint import JointOptimum

DISTRIBUTED = 20
"""Finished runs of a set from which on its distribution is described. A choice."""
MOST_DISTRIBUTIONS = 60
MOST_COMBINATIONS = 200
"""Of the other axes for which the optimum along one axis is looked for."""
MOST_COMPARED = 6
"""Values of an axis of words that are compared pair by pair."""


@dataclass(frozen=True, slots=True)
class Analysis:
    """best: the set with the smallest mean.  overall: the optimum along each numeric axis, the others averaged over.
    apart: the same at each combination of the others.  effects: of a grid.  influences, joint: of scattered points.
    distributions: row of the set in samples.points -> its runs.  drift: None where no order was given.
    """

    samples: Samples
    summaries: tuple[SetSummary, ...]
    best: SetSummary | None
    overall: tuple[Optimum, ...]
    apart: tuple[Optimum, ...]
    effects: Effects | None
    influences: tuple[Influence, ...]
    joint: JointOptimum | None
    comparisons: tuple[Comparison, ...]
    distributions: dict[int, Distribution]
    drift: Drift | None

    @property
    def finished(self) -> int:
        return sum(one.runs for one in self.summaries)

    @property
    def failed(self) -> int:
        return sum(one.failed for one in self.summaries)


def analyse(
    rows: Iterable[Row], axes: Sequence[str], order: Sequence[int] | None = None, metric: str = ME
) -> Analysis:
    """rows: of a study's table.  order: indices as they were carried out, where that may matter (a rig)."""
    found = samples(rows, axes, metric)
    summaries = summarise(found)
    return Analysis(
        found,
        summaries,
        best(summaries),
        () if found.scattered else _overall(found),
        () if found.scattered else _apart(found),
        None if found.scattered else effects(found),
        screening(found) if found.scattered else (),
        _joint(found) if found.scattered else None,
        () if found.scattered else _comparisons(found),
        _distributions(found),
        None if order is None else drift(found, order),
    )


def _searched(found: Samples) -> list[str]:
    """Numeric axes with enough levels for an optimum between them."""
    return [
        axis for axis in found.varied() if found.numeric(axis) and len(found.levels(axis)) >= FEWEST_LEVELS
    ]


def _overall(found: Samples) -> tuple[Optimum, ...]:
    """Of each value of the axes of words by itself: an average over two robots is nobody's."""
    words = [axis for axis in found.varied() if not found.numeric(axis)]
    return tuple(
        one
        for axis in _searched(found)
        for values in itertools.product(*(found.levels(word) for word in words))
        if (one := optimum(found, axis, dict(zip(words, values, strict=True)))) is not None
    )


def _apart(found: Samples) -> tuple[Optimum, ...]:
    optima: list[Optimum] = []
    for axis in _searched(found):
        others = [other for other in found.varied() if other != axis]
        if sum(found.numeric(other) for other in others) == 0:
            continue
        at = [found.axes.index(other) for other in others]
        combinations = dict.fromkeys(tuple(point[column] for column in at) for point in found.points)
        if len(combinations) <= MOST_COMBINATIONS:
            each = (optimum(found, axis, dict(zip(others, values, strict=True))) for values in combinations)
            optima += [one for one in each if one is not None]
    return tuple(optima)


def _joint(found: Samples) -> JointOptimum | None:
    from control.studies.analysis.joint import (
        joint_optimum,  # only a scattered design needs to load the learner
    )

    return joint_optimum(found)


def _comparisons(found: Samples) -> tuple[Comparison, ...]:
    return tuple(
        comparison
        for axis in found.varied()
        if not found.numeric(axis) and len(found.levels(axis)) <= MOST_COMPARED
        for comparison in compare(found, axis)
    )


def _distributions(found: Samples) -> dict[int, Distribution]:
    groups = {place: group for place, group in enumerate(found.groups()) if len(group) >= DISTRIBUTED}
    return {place: describe(group) for place, group in itertools.islice(groups.items(), MOST_DISTRIBUTIONS)}
