"""What a study has found so far, set by set, taken in as its rows are written: what pages ask for every second."""

from __future__ import annotations

import math
import threading
from array import array
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from control.studies.analysis.intervals import NOTHING, Interval, mean_interval
from control.studies.table import METRICS, StudyRow
from server.studies.results_file import new_rows
from server.studies.study import RESULTS, Study


@dataclass(slots=True)
class SetSoFar:
    """Of one set: its values by axis in lab units, and the metrics of its finished runs by name."""

    values: Mapping[str, Any]
    failed: int = 0
    metrics: dict[str, array[float]] = field(default_factory=lambda: {name: array("d") for name in METRICS})

    def add(self, row: StudyRow) -> None:
        if row.state == "failed":
            self.failed += 1
            return
        for name, column in self.metrics.items():
            column.append(row.metric(name))

    @property
    def runs(self) -> int:
        """Finished ones."""
        return len(next(iter(self.metrics.values())))

    def mean(self, metric: str) -> Interval:
        """With its 95 % interval."""
        return mean_interval(self.metrics[metric]) if self.runs else NOTHING


class Digest:
    """Of one study. Reads what was written since it was asked last; for any thread."""

    def __init__(self, study: Study) -> None:
        self._path = study.folder / RESULTS
        self._one_at_a_time = threading.Lock()
        self._begin()

    def _begin(self) -> None:
        self._end = 0
        """Bytes of the file that have been taken in."""
        self._known: set[int] = set()
        self.failed = 0
        self.sets: dict[int, SetSoFar] = {}

    @property
    def done(self) -> int:
        return len(self._known)

    def refresh(self) -> None:
        """A file that has become shorter is another one."""
        with self._one_at_a_time:
            size = self._path.stat().st_size if self._path.exists() else 0
            if size < self._end:
                self._begin()
            rows, self._end = new_rows(self._path, self._end) if size > self._end else ([], self._end)
            for row in rows:
                self._add(row)

    def _add(self, row: StudyRow) -> None:
        """A second row of the same run does not count."""
        if row.index in self._known:
            return
        self._known.add(row.index)
        self.failed += row.state == "failed"
        self.sets.setdefault(row.set, SetSoFar(row.values)).add(row)

    def best(self, metric: str) -> int | None:
        """The number of the set with the smallest mean so far."""
        means = {number: so_far.mean(metric).value for number, so_far in list(self.sets.items())}
        known = {number: mean for number, mean in means.items() if math.isfinite(mean)}
        return min(known, key=lambda number: known[number], default=None)
