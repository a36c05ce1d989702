"""Studies as they cross the edge towards a page or a script: how far they are, and what they have found.

Everything here reads files, and belongs on a worker thread.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from control.studies.analysis.intervals import Interval
from control.studies.checking import runs_at_most
from control.studies.consistency import number_of_sets
from control.studies.definition import StudyDefinition
from control.studies.design import sets_of
from control.studies.quantities import quantity
from server.catalogue.record_json import time_text
from server.studies.digest import Digest, SetSoFar
from server.studies.progress import measure_of
from server.studies.study import Study

if TYPE_CHECKING:
    from server.studies.desk import StudyDesk, Work

MOST_PLANNED = 2000
"""Sets that are listed before they have a run; of a larger study only those that have one."""


class StudyJson:
    """Keeps what it has read of each study's results, since a page asks again every second."""

    def __init__(self, desk: StudyDesk) -> None:
        self._desk = desk
        self._one_at_a_time = threading.Lock()
        self._digests: dict[str, Digest] = {}

    def digest(self, study: Study) -> Digest:
        """Up to date."""
        with self._one_at_a_time:
            digest = self._digests.setdefault(study.id, Digest(study))
        digest.refresh()
        return digest

    def forget(self, id: str) -> None:
        with self._one_at_a_time:
            self._digests.pop(id, None)

    def listed(self) -> list[dict[str, Any]]:
        """All studies, newest first."""
        return self._desk.store.described(self.short)

    def short(self, study: Study) -> dict[str, Any]:
        """As it is listed."""
        digest, condition, work = self.digest(study), study.condition, self._desk.work_on(study.id)
        definition = study.definition
        return {
            "id": study.id,
            "name": definition.name,
            "state": condition.state if work is None else "running",
            "reason": condition.reason,
            "on": definition.on,
            "design": definition.design,
            "created_at": time_text(condition.created),
            "done": digest.done,
            "total": runs_at_most(definition),
            "failed": digest.failed,
            "seconds_left": None if work is None else work.seconds_left,
            "current": _current(work, condition.state),
            "best": best_json(study.definition, digest),
        }

    def whole(self, study: Study, metric: str) -> dict[str, Any]:
        """metric: of which the means of the sets are told."""
        digest = self.digest(study)
        return {
            **self.short(study),
            "definition": study.definition.to_json(),
            "metric": metric,
            "rows": digest.done,
            "axes": axes_json(study.definition),
            "sets": [set_json(*each, metric) for each in _sets(study.definition, digest)],
        }


def _current(work: Work | None, state: str) -> str:
    """In words; a study that another program carries out is none of this server's."""
    if work is not None:
        return work.current
    return "carried out by another program" if state == "running" else ""


def axes_json(definition: StudyDefinition) -> list[dict[str, Any]]:
    """values: in their order; empty where every number of a range is one."""
    choices: dict[str, list[Any]] = {axis.of: list(axis.choices or ()) for axis in definition.axes}
    if definition.design == "list":
        choices = {
            name: list(dict.fromkeys(one[name] for one in definition.sets if name in one))
            for name in definition.axis_names
        }
    return [_axis_json(definition, name, values) for name, values in choices.items()]


def _axis_json(definition: StudyDefinition, name: str, values: list[Any]) -> dict[str, Any]:
    of = quantity(definition, name)
    return {"name": name, "title": of.title, "unit": of.unit, "values": values}


def _sets(definition: StudyDefinition, digest: Digest) -> Iterator[tuple[int, Mapping[str, Any], SetSoFar]]:
    """Number, values by axis, and what is known; of a search those that were tried."""
    known = dict(digest.sets)
    if definition.design != "tune" and number_of_sets(definition) <= MOST_PLANNED:
        for number, values in enumerate(sets_of(definition)):
            yield number, values, known.get(number) or SetSoFar(values)
        return
    for number, so_far in sorted(known.items()):
        yield number, so_far.values, so_far


def set_json(number: int, values: Mapping[str, Any], so_far: SetSoFar, metric: str) -> dict[str, Any]:
    """runs: finished ones, which alone are in the mean; low, high: its 95 % interval, null for one run."""
    return {
        "set": number,
        "values": dict(values),
        "runs": so_far.runs,
        "failed": so_far.failed,
        **interval_json(so_far.mean(metric)),
    }


def interval_json(interval: Interval) -> dict[str, float | None]:
    """JSON has no NaN."""
    return {
        "mean": _finite(interval.value),
        "low": _finite(interval.low),
        "high": _finite(interval.high),
    }


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


def best_json(definition: StudyDefinition, digest: Digest) -> dict[str, Any] | None:
    """The set with the smallest mean so far, of what the study is about; None before the first run has finished."""
    metric = measure_of(definition)
    number = digest.best(metric)
    if number is None:
        return None
    so_far = digest.sets[number]
    return {
        **set_json(number, so_far.values, so_far, metric),
        "metric": metric,
        "words": _words(definition, so_far),
    }


def _words(definition: StudyDefinition, so_far: SetSoFar) -> str:
    """`tilt 25°, path step 0.1 s`."""
    parts = []
    for name, value in so_far.values.items():
        of = quantity(definition, name)
        unit = "" if of.unit in ("", "1") else of.unit if of.unit == "°" else f" {of.unit}"
        shown = (
            f"{value:.6g}" if isinstance(value, int | float) and not isinstance(value, bool) else str(value)
        )
        parts.append(f"{of.title.lower()} {shown}{unit}")
    return ", ".join(parts)
