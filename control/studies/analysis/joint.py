"""Where among scattered points a metric is smallest, all axes together, and how surely that is known.

The model is that of the auto-tune: a Gaussian process over the axes. Surfaces drawn from it, each with its own
smallest place, give the intervals.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc

from control.studies.analysis.intervals import LEVEL, Interval
from control.studies.analysis.samples import Samples
from control.studies.tuning.error_model import ErrorModel
from control.studies.tuning.space import Axis, Range, Space, Words

Array = NDArray[np.float64]
FEWEST = 10
"""Sets below which no surface is laid through them; a choice."""
MOST_SETS = 250
"""Of which the model is made, evenly chosen: its cost grows with their third power."""
CANDIDATES = 512
DRAWS = 500
SEED = 1963


@dataclass(frozen=True, slots=True)
class JointOptimum:
    """where: numeric axis -> place of the smallest expected value, lab units, with its interval.
    words: other axis -> its value there, and the share of the drawn surfaces that agree.  value: the metric there.
    """

    where: Mapping[str, Interval]
    words: Mapping[str, tuple[Any, float]]
    value: Interval


def joint_optimum(samples: Samples) -> JointOptimum | None:
    """None for fewer than FEWEST sets with finished runs, or a metric that is not above zero."""
    groups = samples.groups()
    measured = [place for place, group in enumerate(groups) if len(group) and group.mean() > 0.0]
    if len(measured) < FEWEST or not samples.varied():
        return None
    measured = [
        measured[at] for at in np.linspace(0, len(measured) - 1, min(len(measured), MOST_SETS)).astype(int)
    ]
    part = samples.chosen(measured)
    space = Space(tuple(_axis(part, axis) for axis in part.varied()))
    points = [tuple(zip(part.axes, point, strict=True)) for point in part.points]
    model = ErrorModel(space.places(points), np.array([groups[place].mean() for place in measured]))
    return _found(part, space, model)


def _axis(samples: Samples, axis: str) -> Axis:
    levels = samples.levels(axis)
    return Range(axis, levels[0], levels[-1]) if samples.numeric(axis) else Words(axis, tuple(levels))


def _found(samples: Samples, space: Space, model: ErrorModel) -> JointOptimum:
    shares = qmc.Sobol(len(space.axes), rng=np.random.default_rng(SEED)).random(CANDIDATES)
    candidates = [space.values(space.point(point)) for point in shares]
    places = space.places([tuple(values.items()) for values in candidates])
    belief, drawn = model.believe(places), model.drawn(places, DRAWS, SEED)
    best, bests = int(np.argmin(belief.mean)), np.argmin(drawn, axis=0)
    where, words = {}, {}
    for axis in space.axes:
        found = [candidates[at][axis.name] for at in bests]
        value = candidates[best][axis.name]
        if samples.numeric(axis.name):
            where[axis.name] = _interval(float(value), np.array(found, dtype=float))
        else:
            words[axis.name] = (value, found.count(value) / len(found))
    errors = model.error(drawn[best])
    return JointOptimum(where, words, _interval(float(model.error(belief.mean[best : best + 1])[0]), errors))


def _interval(value: float, draws: Array) -> Interval:
    low, high = np.quantile(draws, (0.5 - 0.5 * LEVEL, 0.5 + 0.5 * LEVEL))
    return Interval(value, min(float(low), value), max(float(high), value))
