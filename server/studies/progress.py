"""How far a study is, and what it has found so far."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from control.studies.definition import StudyDefinition
from control.studies.table import StudyRow
from server.studies.results_file import Results

MEASURE = "normalized_mean_error"
"""What sets are compared by, unless a study looks for the smallest of another: the paper's ME."""


@dataclass(frozen=True, slots=True)
class BestSet:
    """The set with the smallest mean so far. values: of its axes, lab units.  runs: that the mean is taken over."""

    set: int
    values: Mapping[str, Any]
    mean: float
    runs: int


@dataclass(frozen=True, slots=True)
class Progress:
    """done: runs with a row, those of earlier sittings too.  rate: runs a second of this sitting, 0 before the first.

    seconds_left: by that rate; None before there is one.  measure: what `best` is best by.
    """

    done: int
    total: int
    failed: int
    rate: float
    seconds_left: float | None
    measure: str
    best: BestSet | None

    def to_json(self) -> dict[str, Any]:
        best = self.best
        return {
            "done": self.done,
            "total": self.total,
            "failed": self.failed,
            "runs_per_s": round(self.rate, 4),
            "seconds_left": None if self.seconds_left is None else round(self.seconds_left, 1),
            "best": None if best is None else best_json(best, self.measure),
        }


def best_json(best: BestSet, measure: str) -> dict[str, Any]:
    return {
        "set": best.set,
        "values": dict(best.values),
        "runs": best.runs,
        "measure": measure,
        "mean": best.mean,
    }


def measure_of(definition: StudyDefinition) -> str:
    """The name of the figure that the best set has least of."""
    return definition.tune.minimise if definition.design == "tune" else MEASURE


Watch = Callable[[Progress], None]
"""Told after each piece of work."""


class Progression:
    """Running means of each set; its size grows with the sets, not with the runs."""

    def __init__(self, total: int, results: Results, measure: str = MEASURE) -> None:
        """results: the rows so far, and from now on."""
        self._total = total
        self._results = results
        self._measure = measure
        self._sets: dict[int, tuple[int, float, int]] = {}
        """Runs, their sum, and the index of one of them, by set."""
        self._already = len(results)
        self._began = time.monotonic()
        for row in results.rows():
            self.add(row)

    def add(self, row: StudyRow) -> None:
        value = row.metric(self._measure)
        if not math.isfinite(value):
            return
        runs, sum_, index = self._sets.get(row.set, (0, 0.0, row.index))
        self._sets[row.set] = (runs + 1, sum_ + value, index)

    def now(self) -> Progress:
        done = len(self._results)
        elapsed = time.monotonic() - self._began
        rate = (done - self._already) / elapsed if elapsed > 0.0 else 0.0
        left = max(self._total - done, 0) / rate if rate > 0.0 else None
        return Progress(done, self._total, self._results.failed, rate, left, self._measure, self.best())

    def best(self) -> BestSet | None:
        if not self._sets:
            return None
        set_ = min(self._sets, key=lambda each: (self._mean(each), each))
        return BestSet(set_, self._results[self._sets[set_][2]].values, self._mean(set_), self._sets[set_][0])

    def _mean(self, set_: int) -> float:
        runs, sum_, _ = self._sets[set_]
        return sum_ / runs
