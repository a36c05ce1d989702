"""The run that a request names, as the catalogue and its recording have it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from server.api.problems import Problem, Rejected, not_found
from server.catalogue.errors import CatalogueError, NoSuchRun

if TYPE_CHECKING:
    from server.archive import Archive
    from server.catalogue.records import RunRecord


def record_of(archive: Archive, run_id: str) -> RunRecord:
    """It blocks; raises `Rejected`."""
    try:
        return archive.catalogue.get(run_id)
    except NoSuchRun as error:
        raise not_found(str(error)) from error
    except CatalogueError as error:
        raise Rejected(Problem(503, "No catalogue", str(error))) from error


def path_of(archive: Archive, run_id: str) -> Path:
    """Where its recording is; raises `Rejected` where there is none. It blocks."""
    from server.archive import NoSuchName

    try:
        path = archive.path_of(run_id)
    except NoSuchName as error:
        raise not_found(str(error)) from error
    if not path.exists():
        raise not_found(f"Of the run {run_id} there is no recording.")
    return path
