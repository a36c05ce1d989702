"""What the catalogue is told of runs that a program left behind. Everything raises `CatalogueError`."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from server.catalogue.edits import edits_beside
from server.catalogue.errors import NoSuchRun
from server.catalogue.records import INTERRUPTED, RUNNING, RunRecord
from server.catalogue.shelf import file_of
from server.recording.reading.listing import REASON, listed
from server.recording.reading.recording import Recording, Unreadable

if TYPE_CHECKING:
    from server.catalogue.catalogue import Catalogue

OF_FILE = ("recording_state", "size_bytes", "frames", "sparkline")
OF_END = ("state", "reason", "ended_at", "metrics")


def put_recovered(catalogue: Catalogue, folder: Path, record: RunRecord) -> None:
    """record: as the recovered file has it. What is known already of the run's end, or written about it, stays."""

    def made(known: RunRecord | None) -> RunRecord | None:
        if known is not None:
            fields = OF_FILE if known.state != RUNNING and known.ended_at is not None else OF_FILE + OF_END
            return replace(known, **{name: getattr(record, name) for name in fields})
        was_deleted = not file_of(folder, record.id).exists()
        return None if was_deleted else replace(record, **edits_beside(folder, record.id))

    catalogue.renew(record.id, made)


def put_torn(catalogue: Catalogue, id: str, size: int) -> None:
    """Nothing of its recording can be read. size: of what is kept of it, bytes."""
    try:
        known = catalogue.get(id)
    except NoSuchRun:
        return
    catalogue.update(id, recording_state="lost", size_bytes=size, **_end(known))


def end_row(catalogue: Catalogue, path: Path, known: RunRecord) -> None:
    """A run that was going on and that nobody records any more. path: of its recording, if there is one."""
    try:
        with Recording.open(path) as recording:
            if recording.is_whole:
                put_recovered(catalogue, path.parent, listed(known.id, recording))
                return
            file = {"recording_state": "recovered", "size_bytes": recording.size}  # to be mended another time
    except Unreadable:
        file = {"recording_state": "lost", "size_bytes": _size(path)}
    is_open = known.recording_state == "writing"
    catalogue.update(known.id, **_end(known), **(file if is_open else {}))


def _size(path: Path) -> int:
    """Bytes; 0 for a file that is not there."""
    try:
        return path.stat().st_size
    except OSError:
        return 0


def _end(known: RunRecord) -> dict[str, Any]:
    return {"state": INTERRUPTED, "reason": REASON} if known.state == RUNNING else {}
