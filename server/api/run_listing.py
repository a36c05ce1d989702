"""Runs as the outside sees them: those of the catalogue, and of this session what is not in it yet.

Everything here blocks, and belongs on a worker thread.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from control.runs import Run, RunState
from server.api.choices import selection_json
from server.catalogue.errors import BadCursor, CatalogueError, NoSuchRun
from server.catalogue.queries import joined
from server.catalogue.record_json import record_json
from server.catalogue.records import Page, RunQuery, RunRecord, Totals
from server.catalogue.searching import matches
from server.metrics_json import metrics_json

if TYPE_CHECKING:
    from server.archive import Archive
    from server.catalogue.catalogue import Catalogue
    from server.rig import Rig


@dataclass(frozen=True, slots=True)
class Asked:
    """Which page of which runs. cursor: None for the first page."""

    query: RunQuery
    cursor: str | None
    limit: int


def record_of(run: Run, rig: Rig) -> RunRecord:
    """A run of this session that the catalogue does not have, or not yet."""
    request = run.request
    return RunRecord(
        id=run.id,
        started_at=run.started_at,
        state=run.state.value,
        reason=run.reason,
        label=request.label,
        tags=request.tags,
        controller=request.selection.controller.name,
        trajectory=request.selection.trajectory.name,
        selection=selection_json(request.selection),
        passes=request.passes,
        duration_s=request.duration,
        unattended=request.unattended,
        metrics=None if run.metrics is None else metrics_json(run.metrics),
        simulated=rig.settings.is_simulated,
        rig=rig.settings.name,
    )


def brought_up_to_date(record: RunRecord, session: Iterable[Run]) -> RunRecord:
    """The rig knows of a run's end, and of another selection, a moment before the catalogue does."""
    run = next((run for run in session if run.id == record.id), None)
    if run is None or record.state != RunState.RUNNING:
        return record
    metrics = None if run.metrics is None else metrics_json(run.metrics)
    selection = selection_json(run.request.selection)
    return replace(record, state=run.state.value, reason=run.reason, metrics=metrics, selection=selection)


def page_json(rig: Rig, archive: Archive, asked: Asked) -> dict[str, Any]:
    """One page, newest first, with the total of the query and what all runs take.

    trouble: why the catalogue cannot be read, if it cannot; then this session's runs are all there is to show.
    Raises `BadCursor`.
    """
    session = list(rig.runs)
    try:
        page, totals, trouble = *_found(rig, archive.catalogue, session, asked), ""
    except BadCursor:
        raise
    except CatalogueError as error:
        page, totals, trouble = *_of_session(rig, session, asked), str(error)
    return {
        "runs": [record_json(brought_up_to_date(record, session)) for record in page.runs],
        "next": page.next,
        "total": page.total,
        "totals": totals_json(totals, archive.folder),
        "trouble": trouble,
    }


def _found(rig: Rig, catalogue: Catalogue, session: list[Run], asked: Asked) -> tuple[Page, Totals]:
    forget_deleted(rig, catalogue, session)
    known = catalogue.known([run.id for run in session])
    page = catalogue.page(
        asked.query, asked.cursor, asked.limit
    )  # later, so that a new run is in one of the two
    known |= {run.id for run in page.runs}
    waiting = _matching(rig, [run for run in session if run.id not in known], asked.query)
    return joined(page, waiting, asked.cursor, asked.limit), catalogue.totals()


def forget_deleted(rig: Rig, catalogue: Catalogue, session: list[Run]) -> None:
    """Take off both lists what another program has deleted; raises `CatalogueError`."""
    for id in catalogue.gone([run.id for run in session]):
        if rig.runs.forget(id):
            session[:] = [run for run in session if run.id != id]


def _of_session(rig: Rig, session: Sequence[Run], asked: Asked) -> tuple[Page, Totals]:
    runs = _matching(rig, session, asked.query)
    return joined(Page((), None, 0), runs, asked.cursor, asked.limit), Totals(len(session), 0, 0)


def _matching(rig: Rig, runs: Iterable[Run], query: RunQuery) -> list[RunRecord]:
    return [record for run in runs if matches(query, record := record_of(run, rig))]


def totals_json(totals: Totals, folder: Path) -> dict[str, Any]:
    return {
        "runs": totals.runs,
        "bytes": totals.size,
        "pinned_bytes": totals.pinned_size,
        "free_bytes": free_space(folder),
    }


def free_space(folder: Path) -> int | None:
    """Bytes that a recording may still take; None where that cannot be found out."""
    try:
        return shutil.disk_usage(folder if folder.exists() else folder.parent).free
    except OSError:
        return None


def one_json(rig: Rig, archive: Archive, id: str) -> dict[str, Any]:
    """One run with its settings; raises `NoSuchRun`."""
    session = list(rig.runs)
    try:
        record = archive.catalogue.get(id)
    except NoSuchRun:
        forget_deleted(rig, archive.catalogue, session)
        run = next((run for run in session if run.id == id), None)
        if run is None:
            raise
        record = record_of(run, rig)
    return {**record_json(brought_up_to_date(record, session)), "settings": record.settings}
