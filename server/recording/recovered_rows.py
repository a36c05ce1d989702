"""What the catalogue is told of runs that a program left behind. Everything raises `CatalogueError`."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from server.catalogue.edits import edits_beside
from server.catalogue.errors import NoSuchRun
from server.catalogue.records import INTERRUPTED, RUNNING, RunRecord
from server.recording.listing import REASON, listed
from server.recording.reading import Recording, Unreadable

if TYPE_CHECKING:
    from server.catalogue.catalogue import Catalogue

OF_FILE = ("recording_state", "size_bytes", "frames", "sparkline")
OF_END = ("state", "reason", "ended_at", "metrics")


def put_recovered(catalogue: Catalogue, folder: Path, record: RunRecord) -> None:
    """record: as the recovered file has it. What is known already of the run's end, or written about it, stays."""
    try:
        known = catalogue.get(record.id)
    except NoSuchRun:
        if not catalogue.known([record.id]):  # else it is being deleted
            catalogue.put(replace(record, **edits_beside(folder, record.id)))
        return
    fields = OF_FILE + OF_END if known.state == RUNNING else OF_FILE
    catalogue.update(record.id, **{name: getattr(record, name) for name in fields})


def put_torn(catalogue: Catalogue, id: str) -> None:
    """Nothing of its recording can be read."""
    try:
        known = catalogue.get(id)
    except NoSuchRun:
        return
    catalogue.update(id, recording_state="lost", size_bytes=0, **_end(known))


def end_row(catalogue: Catalogue, path: Path, known: RunRecord) -> None:
    """A run that was going on and that nobody records any more. path: of its recording, if there is one."""
    try:
        with Recording.open(path) as recording:
            if recording.is_whole:
                put_recovered(catalogue, path.parent, listed(known.id, recording))
                return
    except Unreadable:
        if known.recording_state == "writing" and not path.exists():
            catalogue.update(known.id, recording_state="lost", size_bytes=0, **_end(known))
            return
    catalogue.update(known.id, **_end(known))


def _end(known: RunRecord) -> dict[str, Any]:
    return {"state": INTERRUPTED, "reason": REASON} if known.state == RUNNING else {}
