"""A batch study is carried out: its plan is asked what is next, workers do it, rows are kept in the plan's order.

Rows are written in one order whoever was first, so what stands in a study, and where a rule ends it, does not depend
on the number of workers, on their speed, or on how often it was interrupted.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice

from control.metrics import Metrics
from control.studies.definition import StudyDefinition
from control.studies.errors import StudyError
from control.studies.plan import Plan, PlannedRun
from control.studies.table import StudyRow
from control.studies.workers import Failed, Workers, WorkersLost, hired
from server.signals import ProgramEnds
from server.studies.condition import StudyState
from server.studies.errors import StudyStoreError
from server.studies.progress import Progression, Watch, measure_of
from server.studies.study import Carrying, Study

HOUR = 3600.0
BY_THE_OPERATOR = "stopped by the operator"


@dataclass(frozen=True, slots=True)
class Workforce:
    """jobs: processes, 0 for one a core.  dask: address of a scheduler instead."""

    jobs: int = 0
    dask: str | None = None


@dataclass(frozen=True, slots=True)
class Carried:
    """How a study was left, and why."""

    state: StudyState
    reason: str = ""


def carry_out_batch(
    study: Study, workforce: Workforce = Workforce(), watch: Watch = lambda _: None
) -> Carried:
    """All that is left of a study. Raises `StudyBusy` where somebody else is at it, `StudyStoreError`, and
    `StudyError` for a run that cannot be planned, as when its plug-in is missing.

    Ctrl-C (KeyboardInterrupt) leaves it stopped, `ProgramEnds` interrupted; both are raised on. Whatever comes
    between, it can go on later.
    """
    with study.claimed() as carrying:
        try:
            carried = _carried(study, carrying, workforce, watch)
        except ProgramEnds:
            raise
        except KeyboardInterrupt:
            carrying.ends("stopped", BY_THE_OPERATOR)
            raise
        except WorkersLost as error:
            carried = Carried("interrupted", str(error))
        except (StudyStoreError, StudyError) as error:
            carrying.ends("interrupted", str(error))
            raise
        carrying.ends(carried.state, carried.reason)
        return carried


def _carried(study: Study, carrying: Carrying, workforce: Workforce, watch: Watch) -> Carried:
    plan = study.definition.plan()
    rules, progression = Rules(study.definition, carrying, plan), progression_of(study, plan)
    if rules.failed is not None:
        return rules.failed
    with hired(workforce.jobs, workforce.dask) as workers:
        for rows in _rows(plan, carrying, workers):
            kept = rules.allowed(rows)
            carrying.extend(kept)
            for row in kept:
                progression.add(row)
            watch(progression.now())
            if (stopped := rules.stopped) is not None:
                return stopped
    return Carried("finished")


def progression_of(study: Study, plan: Plan) -> Progression:
    return Progression(plan.total, study.results(), measure_of(study.definition))


def _rows(plan: Plan, carrying: Carrying, workers: Workers) -> Iterator[list[StudyRow]]:
    """What came of the runs that are left, as many at once as were done together."""
    while indices := plan.next(carrying.done):
        planned = (plan.run(index, carrying.done) for index in indices)
        for some in workers.in_chunks(planned):
            yield [_row(run, outcome) for run, outcome in some]


def _row(run: PlannedRun, outcome: Metrics | Failed) -> StudyRow:
    if isinstance(outcome, Failed):
        return StudyRow.failed(run, outcome.reason)
    return StudyRow.finished(run, outcome)


class Rules:
    """When a study ends before its plan does. A limit of 0 never ends it."""

    def __init__(self, definition: StudyDefinition, carrying: Carrying, plan: Plan) -> None:
        self._plan, self._done = plan, carrying.done
        self._limit = definition.stop.failed_in_a_row
        self._hours = definition.stop.hours
        self._until = time.monotonic() + (self._hours * HOUR if self._hours else math.inf)
        self._in_a_row = _failed_last(carrying)

    def allowed(self, rows: Sequence[StudyRow]) -> Sequence[StudyRow]:
        """Those up to the one that ends the study."""
        for number, row in enumerate(rows, start=1):
            self._in_a_row = self._in_a_row + 1 if row.state == "failed" else 0
            if self._has_failed:
                return rows[:number]
        return rows

    @property
    def stopped(self) -> Carried | None:
        """Where it ends now, after one run or more of this sitting."""
        if self.failed is not None:
            return self.failed
        if time.monotonic() >= self._until and self._plan.next(self._done):
            return Carried("stopped", f"its {self._hours:g} hours are over")
        return None

    @property
    def failed(self) -> Carried | None:
        """Also where whoever wrote the last of those rows died before it could say so."""
        return Carried("failed", f"{self._in_a_row} runs in a row failed") if self._has_failed else None

    @property
    def _has_failed(self) -> bool:
        return 0 < self._limit <= self._in_a_row


def _failed_last(carrying: Carrying) -> int:
    """How many of the newest rows failed; a person who goes on with a study that failed starts anew."""
    in_a_row = 0
    for row in islice(carrying.done.rows(), carrying.before.pardoned, None):
        in_a_row = in_a_row + 1 if row.state == "failed" else 0
    return in_a_row
