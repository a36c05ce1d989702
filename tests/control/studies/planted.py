"""Tables of studies whose answer is known, because it was planted."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from control.studies.analysis.samples import ME, Samples, samples
from control.studies.definition import StudyDefinition
from control.studies.plan import PlannedRun
from control.studies.table import StudyRow, StudyTable

Errors = Callable[[Mapping[str, Any], np.random.Generator], float | None]
"""ME of one run from the values of its axes; None: the run failed."""


def planted_table(definition: StudyDefinition, errors: Errors, seed: int = 0) -> StudyTable:
    plan = definition.plan()
    rng = np.random.default_rng(seed)
    done: dict[int, StudyRow] = {}
    while indices := plan.next(done):
        done |= {index: _row(plan.run(index, done), errors, rng) for index in sorted(indices)}
    return StudyTable(plan.axes, done.values())


def _row(run: PlannedRun, errors: Errors, rng: np.random.Generator) -> StudyRow:
    error = errors(run.values, rng)
    place = (run.index, run.set, run.repeat, run.seed)
    if error is None:
        return StudyRow(*place, "failed", dict(run.values), reason="the robot left the workspace")
    figures = {ME: error, "mean_error_mm": 10.0 * error, "duration_s": 2.0}
    return StudyRow(*place, "finished", dict(run.values), figures)


def planted(axes: Mapping[str, list[Any]], repeats: int, errors: Errors, seed: int = 0) -> Samples:
    """A grid's samples."""
    definition = StudyDefinition.from_json({
        "name": "planted", "repeats": repeats,
        "axes": [{"of": name, "values": values} for name, values in axes.items()],
    })  # fmt: skip
    table = planted_table(definition, errors, seed)
    return samples(table.rows, table.axes)


def one_axis(
    levels: list[float], repeats: int, error: Callable[[float], float], noise: float, seed: int
) -> Samples:
    """Over the tilt, without the plan's checks: quick enough for hundreds."""
    rng = np.random.default_rng(seed)
    place = np.repeat(np.arange(len(levels)), repeats)
    value = np.array([error(levels[at]) for at in place]) + noise * rng.standard_normal(len(place))
    points = tuple((level,) for level in levels)
    return Samples(
        ME, ("gait.tilt_deg",), tuple(range(len(levels))), points, place, np.arange(len(place)), value
    )
