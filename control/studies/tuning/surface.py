"""What a tuning has learned, drawn out over one or two axes: the error expected, and how sure that is."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from control.studies.definition import StudyDefinition
from control.studies.errors import StudyError
from control.studies.table import StudyRow
from control.studies.tuning.error_model import ErrorModel
from control.studies.tuning.space import Axis, Floats, Point, Space, point_of
from control.studies.tuning.trials import trials
from control.studies.tuning.tuner import Tuner

MARKS = 41
"""Values of a range that are drawn out: a picture's worth."""

MOST_AXES = 2
"""That a flat picture can show."""


@dataclass(frozen=True, slots=True)
class Sample:
    """One run. error: in the unit of the metric; None of a run that failed."""

    values: Mapping[str, Any]
    error: float | None


@dataclass(frozen=True, slots=True)
class Surface:
    """The learned error over one or two axes, all others at the best point.

    axes: names, the one drawn to the right first.  marks: values by axis, lab units, in order.
    mean, deviation: shape of the marks, the last axis first, so (up, right) or (right,); unit of the metric.
    deviation: of the expected mean, not of single runs.  best: values by axis.
    """

    metric: str
    axes: tuple[str, ...]
    marks: tuple[tuple[Any, ...], ...]
    mean: Floats
    deviation: Floats
    samples: tuple[Sample, ...]
    best: Mapping[str, Any]

    def to_json(self) -> dict[str, Any]:
        return {
            "metric": self.metric,
            "axes": list(self.axes),
            "marks": [list(marks) for marks in self.marks],
            "mean": self.mean.tolist(),
            "deviation": self.deviation.tolist(),
            "samples": [{"values": dict(s.values), "error": s.error} for s in self.samples],
            "best": dict(self.best),
        }


def learned_surface(
    definition: StudyDefinition, rows: Mapping[int, StudyRow], across: Sequence[str] = ()
) -> Surface | None:
    """rows: by index.  across: one or two of the tuned axes; without, the two along which the error varies most.

    None as long as no run has finished. Raises `StudyError` for an axis that is not tuned.
    """
    tried = trials(rows.values(), definition.tune.minimise)
    tuner = Tuner(definition)
    model = tuner.model(tried)
    if model is None:
        return None
    best = tuner.best(tried)
    chosen = _chosen(tuner, model, best, across)
    marks = tuple(tuple(axis.marks(MARKS)) for axis in chosen)
    belief = model.believe(tuner.space.places(_spanned(best, chosen, marks)))
    shape = tuple(len(m) for m in reversed(marks))
    return Surface(
        metric=definition.tune.minimise,
        axes=tuple(axis.name for axis in chosen),
        marks=marks,
        mean=model.error(belief.mean).reshape(shape),
        deviation=(model.error(belief.mean) * belief.deviation).reshape(shape),
        samples=tuple(Sample(tuner.space.values(trial.point), trial.error) for trial in tried),
        best=tuner.space.values(best),
    )


def _chosen(tuner: Tuner, model: ErrorModel, best: Point, across: Sequence[str]) -> tuple[Axis, ...]:
    """In the order of the study's axes, unless they were named."""
    axes = {axis.name: axis for axis in tuner.space.axes}
    if across:
        return tuple(_known(axes, name) for name in across[:MOST_AXES])
    varying = sorted(axes.values(), key=lambda axis: -_variation(tuner.space, model, best, axis))[:MOST_AXES]
    return tuple(axis for axis in axes.values() if axis in varying)


def _known(axes: Mapping[str, Axis], name: str) -> Axis:
    if name not in axes:
        raise StudyError(f'axis "{name}" is not tuned in this study; its axes are {", ".join(axes)}')
    return axes[name]


def _variation(space: Space, model: ErrorModel, best: Point, axis: Axis) -> float:
    """How much the expected error varies along an axis through the best point, in log units."""
    line = _spanned(best, (axis,), (tuple(axis.marks(MARKS)),))
    return float(np.ptp(model.believe(space.places(line)).mean))


def _spanned(best: Point, axes: Sequence[Axis], marks: Sequence[Sequence[Any]]) -> list[Point]:
    """The best point with every combination of the marks; the first axis changes fastest."""
    names = [axis.name for axis in reversed(axes)]
    combinations = itertools.product(*reversed(marks))
    return [point_of(dict(best) | dict(zip(names, values, strict=True))) for values in combinations]
