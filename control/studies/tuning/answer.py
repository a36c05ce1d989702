"""The result of an auto-tune: the best point, what the model expects there, and what its last runs measured."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from scipy.stats import t as student

from control.studies.definition import StudyDefinition
from control.studies.table import StudyRow
from control.studies.tuning.error_model import ErrorModel
from control.studies.tuning.plan import TunePlan
from control.studies.tuning.space import Floats, Point
from control.studies.tuning.trials import trials
from control.studies.tuning.tuner import Tuner

NORMAL_95 = 1.96
"""Deviations of a normal distribution that 95 % lie within."""


@dataclass(frozen=True, slots=True)
class Interval:
    """A mean and its 95 % interval, in the unit of the metric; None where there is none to tell."""

    mean: float
    low: float | None
    high: float | None


@dataclass(frozen=True, slots=True)
class Answer:
    """What to walk with.

    values: by axis, lab units.  metric: what was minimised.
    expected: the mean of runs there, by the model of all runs before the confirmation.
    measured: by the runs of the confirmation alone, which had no part in choosing the point; None before.
    runs: finished runs of the confirmation.  left: those of it that are still to come.
    """

    values: Mapping[str, Any]
    metric: str
    expected: Interval
    measured: Interval | None
    runs: int
    left: int

    def to_json(self) -> dict[str, Any]:
        return {**asdict(self), "values": dict(self.values), "confirmed": self.measured is not None}


def answer(definition: StudyDefinition, rows: Mapping[int, StudyRow]) -> Answer | None:
    """rows: by index. None as long as no run has finished."""
    confirming = TunePlan(definition).blocks(rows)[-1]
    tried = trials(rows.values(), definition.tune.minimise)
    before = [trial for trial in tried if not (confirming.confirms and trial.index in confirming.indices)]
    tuner = Tuner(definition)
    model = tuner.model(before)
    if model is None:
        return None
    last = [trial for trial in tried if confirming.confirms and trial.index in confirming.indices]
    point = last[0].point if last else tuner.best(before)
    measured = np.array([trial.error for trial in last if trial.error is not None])
    return Answer(
        values=tuner.space.values(point),
        metric=definition.tune.minimise,
        expected=_expected(tuner, model, point),
        measured=_measured(measured) if len(measured) else None,
        runs=len(measured),
        left=definition.tune.confirm - len(last),
    )


def _expected(tuner: Tuner, model: ErrorModel, point: Point) -> Interval:
    belief = model.believe(tuner.space.places([point]))
    mean, low, high = model.error(belief.mean + belief.deviation * np.array([0.0, -NORMAL_95, NORMAL_95]))
    return Interval(float(mean), float(low), float(high))


def _measured(found: Floats) -> Interval:
    """Student's interval; one run has none."""
    mean, runs = float(found.mean()), len(found)
    if runs == 1:
        return Interval(mean, None, None)
    half = float(student.ppf(0.975, runs - 1)) * float(found.std(ddof=1)) / math.sqrt(runs)
    return Interval(mean, mean - half, mean + half)
