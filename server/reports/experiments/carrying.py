"""Carries the studies out, with all cores, and keeps their tables."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from control.studies.batch import Failed
from control.studies.table import StudyRow, StudyTable
from control.studies.workers import Workers, hired
from server.reports.experiments.designs import Experiment

Watch = Callable[[Experiment, int, int], None]
"""Told of each run: the study, runs done of all studies, and their number."""

Tables = dict[str, StudyTable]
"""By the studies' keys."""

Keep = Callable[[str, StudyTable], None]
"""Given each table as soon as it is whole, with its study's key: half an hour of runs must not hang on a figure."""


def file_of(key: str) -> str:
    """Name of the file that keeps a study's table."""
    return f"section6_{key}.csv"


def carry_out(
    studies: Sequence[Experiment], jobs: int = 0, watch: Watch | None = None, keep: Keep | None = None
) -> Tables:
    """jobs: processes; 0: one a core; the tables do not depend on it. Raises `WorkersLost`."""
    total = sum(study.definition.plan().total for study in studies)
    tables: Tables = {}
    with hired(jobs) as workers:
        for study in studies:
            before = sum(len(table) for table in tables.values())
            table = tables[study.key] = _carried_out(study, workers, before, total, watch)
            if keep is not None:
                keep(study.key, table)
    return tables


def _carried_out(
    study: Experiment, workers: Workers, before: int, total: int, watch: Watch | None
) -> StudyTable:
    plan = study.definition.plan()
    rows: list[StudyRow] = []
    for some in workers.in_chunks(plan.run(index) for index in plan.next({})):
        for run, outcome in some:
            failed = isinstance(outcome, Failed)
            rows.append(StudyRow.failed(run, outcome.reason) if failed else StudyRow.finished(run, outcome))
        if watch is not None:
            watch(study, before + len(rows), total)
    return StudyTable(plan.axes, rows)
