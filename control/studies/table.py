"""The results of a study: a row a run, and all rows as columns."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from control.metrics import Metrics
from control.studies.errors import StudyError

if TYPE_CHECKING:
    from control.studies.plan import PlannedRun

PER_MM = 1e3

METRICS: dict[str, tuple[str, str]] = {
    "normalized_mean_error": ("Mean error over length (ME)", "1"),
    "mean_error_mm": ("Mean error", "mm"),
    "rms_error_mm": ("RMS error", "mm"),
    "max_error_mm": ("Largest error", "mm"),
    "end_error_mm": ("Error at the end", "mm"),
    "travelled_mm": ("Way travelled", "mm"),
    "duration_s": ("Duration", "s"),
    "ticks": ("Ticks", "1"),
    "steps": ("Steps", "1"),
    "sweeps": ("Sweeps", "1"),
    "reversals": ("Reversals", "1"),
}
"""The figures of a run, by name: title and unit."""


def figures(metrics: Metrics) -> dict[str, float]:
    """A run's metrics in the lab's units, by the names of `METRICS`; not rounded."""
    return {
        "normalized_mean_error": metrics.normalized_mean_error,
        "mean_error_mm": metrics.mean_error * PER_MM,
        "rms_error_mm": metrics.rms_error * PER_MM,
        "max_error_mm": metrics.max_error * PER_MM,
        "end_error_mm": metrics.end_error * PER_MM,
        "travelled_mm": metrics.travelled * PER_MM,
        "duration_s": metrics.duration,
        "ticks": metrics.ticks,
        "steps": metrics.steps,
        "sweeps": metrics.sweeps,
        "reversals": metrics.reversals,
    }


RowState = Literal["finished", "failed"]


@dataclass(frozen=True, slots=True)
class StudyRow:
    """One run that is over. index, set, repeat: its place in the plan.  values: axis to value, lab units.

    reason: why it failed.  metrics: lab units, empty when it failed.  run_id: in the catalogue; empty in a batch.
    attempts: how often it was begun.
    """

    index: int
    set: int
    repeat: int
    seed: int
    state: RowState
    values: Mapping[str, Any]
    metrics: Mapping[str, float] = field(default_factory=dict)
    reason: str = ""
    run_id: str = ""
    attempts: int = 1

    @classmethod
    def finished(cls, run: PlannedRun, metrics: Metrics, run_id: str = "", attempts: int = 1) -> StudyRow:
        return cls(
            run.index, run.set, run.repeat, run.seed, "finished", dict(run.values), figures(metrics),
            run_id=run_id, attempts=attempts,
        )  # fmt: skip

    @classmethod
    def failed(cls, run: PlannedRun, reason: str, run_id: str = "", attempts: int = 1) -> StudyRow:
        return cls(
            run.index, run.set, run.repeat, run.seed, "failed", dict(run.values),
            reason=reason, run_id=run_id, attempts=attempts,
        )  # fmt: skip

    def to_json(self) -> dict[str, Any]:
        """Floats keep every bit through `json.dumps` and back."""
        return asdict(self)

    @classmethod
    def from_json(cls, raw: Mapping[str, Any]) -> StudyRow:
        """Raises `StudyError` for what is no row."""
        try:
            row = cls(**raw)
        except TypeError as error:
            raise StudyError(f"this is no row of a study's table: {error}") from None
        numbers = (row.index, row.set, row.repeat, row.seed, row.attempts)
        if not (
            all(type(number) is int for number in numbers)
            and row.state in ("finished", "failed")
            and isinstance(row.values, Mapping)
            and isinstance(row.metrics, Mapping)
            and all(value is None or isinstance(value, int | float) for value in row.metrics.values())
            and isinstance(row.reason, str)
            and isinstance(row.run_id, str)
        ):
            raise StudyError(f"this is no row of a study's table: {dict(raw)!r}")
        return row

    def metric(self, name: str) -> float:
        """NaN where the run failed or has no such figure."""
        value = self.metrics.get(name) if self.state == "finished" else None
        return math.nan if value is None else float(value)


@dataclass(frozen=True, slots=True)
class SetOfRuns:
    """All runs of one set that are over, in the order of their repeats."""

    set: int
    values: Mapping[str, Any]
    rows: tuple[StudyRow, ...]

    @property
    def failed(self) -> int:
        return sum(row.state == "failed" for row in self.rows)

    def column(self, metric: str) -> NDArray[np.float64]:
        """The metric of the runs that finished, (n,)."""
        return np.array(
            [row.metric(metric) for row in self.rows if row.state == "finished"], dtype=np.float64
        )


class StudyTable:
    """Rows by their index, however they came about. axes: names, in the order of the definition."""

    def __init__(self, axes: Sequence[str], rows: Iterable[StudyRow]) -> None:
        self.axes = tuple(axes)
        self.rows = tuple(sorted(rows, key=lambda row: row.index))

    def __len__(self) -> int:
        return len(self.rows)

    def column(self, name: str) -> NDArray[Any]:
        """(n,) an axis (floats where all values are numbers, else objects), a metric (NaN where a run failed), or
        one of index, set, repeat, seed, state, attempts."""
        if name in self.axes:
            return _values([row.values.get(name) for row in self.rows])
        if name in METRICS:
            return np.array([row.metric(name) for row in self.rows], dtype=np.float64)
        if name in ("index", "set", "repeat", "seed", "attempts"):
            return np.array([getattr(row, name) for row in self.rows], dtype=np.int64)
        if name == "state":
            return np.array([row.state for row in self.rows], dtype=object)
        raise KeyError(
            f"there is no column {name!r}; choose an axis ({', '.join(self.axes)}) or one of {list(METRICS)}"
        )

    def by_set(self) -> tuple[SetOfRuns, ...]:
        """In the order of the sets' numbers."""
        grouped: dict[int, list[StudyRow]] = {}
        for row in self.rows:
            grouped.setdefault(row.set, []).append(row)
        return tuple(
            SetOfRuns(number, rows[0].values, tuple(sorted(rows, key=lambda row: row.repeat)))
            for number, rows in sorted(grouped.items())
        )

    def csv(self) -> bytes:
        """UTF-8, a line a run in the order of their index; floats with every digit, nothing of the wall clock."""
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(
            ("index", "set", "repeat", "seed", "state", *self.axes, *METRICS, "reason", "run_id", "attempts")
        )
        for row in self.rows:
            values = (_cell(row.values.get(axis)) for axis in self.axes)
            numbers = (_cell(row.metrics.get(metric)) for metric in METRICS)
            place = (row.index, row.set, row.repeat, row.seed, row.state)
            writer.writerow((*place, *values, *numbers, row.reason, row.run_id, row.attempts))
        return text.getvalue().encode()


def _cell(value: Any) -> str:
    if value is None:
        return ""
    return value if isinstance(value, str) else json.dumps(value)


def _values(values: list[Any]) -> NDArray[Any]:
    if all(isinstance(value, int | float) and not isinstance(value, bool) for value in values):
        return np.array(values, dtype=np.float64)
    column = np.empty(len(values), dtype=object)
    column[:] = values
    return column
