"""A run is deleted whole: its row is hidden, its files go, its row goes. What stops in between is finished later."""

from __future__ import annotations

import contextlib
from pathlib import Path

from server.catalogue.errors import CatalogueError, NoSuchRun, NotNow
from server.catalogue.records import RunRecord
from server.catalogue.shelf import EDITS, RECORDING, TORN, WALKING, Shelf, file_of


def delete_run(shelf: Shelf, id: str) -> RunRecord:
    """The run as it was; raises `NoSuchRun`, `NotNow` for one that goes on or is pinned, `CatalogueError`."""
    record = shelf.catalogue.hide(id, require_deletable)
    try:
        _remove_files(shelf.folder, id)
    except OSError as error:
        shelf.catalogue.show_again(id)
        raise CatalogueError(
            f"the recording of run {id} cannot be deleted: {error.strerror}; "
            "give yourself the right to write to its folder"
        ) from error
    _remove_row(shelf, id)
    return record


def require_deletable(record: RunRecord) -> None:
    """Raises `NotNow`."""
    if record.is_going_on:
        raise NotNow(f"run {record.id} is still going on or being recorded; stop it first")
    if record.pinned:
        raise NotNow(f"run {record.id} is pinned; take its pin away first")


def finish_deletions(shelf: Shelf) -> int:
    """Delete what was about to go when the program ended; how many runs. Raises `CatalogueError`."""
    hidden = shelf.catalogue.hidden()
    for id in hidden:
        try:
            _remove_files(shelf.folder, id)
        except OSError as error:
            raise CatalogueError(f"the recording of run {id} cannot be deleted: {error.strerror}") from error
        _remove_row(shelf, id)
    return len(hidden)


def _remove_row(shelf: Shelf, id: str) -> None:
    """Another program may have finished this deletion meanwhile."""
    with contextlib.suppress(NoSuchRun):
        shelf.catalogue.delete(id)


def _remove_files(folder: Path, id: str) -> None:
    for kind in (EDITS, TORN, WALKING, RECORDING):
        file_of(folder, id, kind).unlink(missing_ok=True)
