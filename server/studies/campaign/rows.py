"""The rows of a campaign's runs, as they end, and those that a crash has kept from being written."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from control.runs import RunState
from control.studies.plan import Plan, PlannedRun
from control.studies.table import RowState, StudyRow
from server.catalogue.catalogue import Catalogue
from server.catalogue.records import RunQuery, RunRecord
from server.studies.study import Carrying


def finished_row(run: PlannedRun, run_id: str, metrics: Mapping[str, Any], attempts: int) -> StudyRow:
    return _row(run, "finished", "", metrics, run_id, attempts)


def failed_row(run: PlannedRun, run_id: str, reason: str, attempts: int) -> StudyRow:
    return _row(run, "failed", reason, {}, run_id, attempts)


def _row(
    run: PlannedRun, state: RowState, reason: str, metrics: Mapping[str, Any], run_id: str, attempts: int
) -> StudyRow:
    return StudyRow(
        index=run.index,
        set=run.set,
        repeat=run.repeat,
        seed=run.seed,
        state=state,
        reason=reason,
        metrics=dict(metrics),
        values=dict(run.values),
        run_id=run_id,
        attempts=attempts,
    )


def put_right(id: str, plan: Plan, book: Carrying, catalogue: Catalogue) -> int:
    """Add the rows of runs that are finished in the catalogue and were not written; how many those are.

    A program that dies between a run's end and its row leaves one such run.
    """
    noted = {row.run_id for row in book.done.values()}
    added = 0
    for record in sorted(_finished(id, catalogue), key=lambda record: record.started_at):
        index = None if record.id in noted else _index(record, catalogue)
        if index is not None and index not in book.done and record.metrics is not None:
            run = plan.run(index, book.done)
            book.append(finished_row(run, record.id, record.metrics, attempts_at(index, id, catalogue)))
            added += 1
    return added


def attempts_at(index: int, id: str, catalogue: Catalogue) -> int:
    """How often a run of a study was begun, by the catalogue; at least once."""
    return max(
        1, sum(_index(record, catalogue) == index for record in _records(RunQuery(study=id), catalogue))
    )


def _finished(id: str, catalogue: Catalogue) -> Iterator[RunRecord]:
    return _records(RunQuery(study=id, state=RunState.FINISHED.value), catalogue)


def _records(query: RunQuery, catalogue: Catalogue) -> Iterator[RunRecord]:
    cursor: str | None = None
    while True:
        page = catalogue.page(query, cursor)
        yield from page.runs
        cursor = page.next
        if cursor is None:
            return


def _index(record: RunRecord, catalogue: Catalogue) -> int | None:
    """Which run of its study it is."""
    index = catalogue.get(record.id).settings.get("study_run")
    return index if isinstance(index, int) else None
