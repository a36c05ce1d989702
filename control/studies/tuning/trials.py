"""What has been tried: the finished and failed runs of a study, as a tuner sees them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from control.studies.table import StudyRow
from control.studies.tuning.space import Floats, Point, point_of


@dataclass(frozen=True, slots=True)
class Trial:
    """One run. error: what is minimised, in the unit of its metric; None of a run that failed."""

    index: int
    set: int
    point: Point
    error: float | None


def trials(rows: Iterable[StudyRow], metric: str) -> list[Trial]:
    """In the order of their index, whatever order they were done in."""
    ordered = sorted(rows, key=lambda row: row.index)
    return [Trial(row.index, row.set, point_of(row.values), _error(row, metric)) for row in ordered]


def errors(tried: Sequence[Trial]) -> Floats:
    """(trials,), above zero, as the model's logarithm wants them.

    A failed run counts like the worst that finished, so that its place is avoided; no worse than that, since
    one cliff would bend the model everywhere. Nothing at all, of a count, is half of the least there was.
    """
    found = [trial.error for trial in tried if trial.error is not None]
    worst = max(found, default=0.0) or 1.0
    least = min((error for error in found if error > 0.0), default=1.0)
    return np.array([worst if trial.error is None else trial.error or least / 2 for trial in tried])


def _error(row: StudyRow, metric: str) -> float | None:
    error = row.metric(metric)
    return error if 0.0 <= error < math.inf else None
