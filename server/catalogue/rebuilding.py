"""The catalogue from the recordings: for a lost or broken one, and for recordings that came from elsewhere."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from server.catalogue.deleting import finish_deletions
from server.catalogue.edits import EDITED, edits_beside
from server.catalogue.errors import NoSuchRun
from server.catalogue.records import RunRecord
from server.catalogue.shelf import RECORDING, Shelf, file_of
from server.recording.listing import listed
from server.recording.reading import Recording, Unreadable
from server.recording.recovery import recover

Watch = Callable[[int, int], None]
"""Told after each recording: how many have been read, and how many there are."""


@dataclass(slots=True)
class Rebuilt:
    """added: runs that were not in the catalogue.  renewed: read once more.  lost: whose recording is gone.

    told: what was mended and what cannot be read, in words.
    """

    added: int = 0
    renewed: int = 0
    lost: int = 0
    told: list[str] = field(default_factory=list)


def rebuild(shelf: Shelf, watch: Watch = lambda _read, _all: None) -> Rebuilt:
    """What a person has written about a run stays. Raises `CatalogueError`."""
    finish_deletions(shelf)
    done = Rebuilt(told=[str(each) for each in recover(shelf.folder, shelf.catalogue)])
    paths = sorted(shelf.folder.glob(f"*{RECORDING}"))
    for read, path in enumerate(paths, start=1):
        _take(shelf, path, done)
        watch(read, len(paths))
    done.lost = _mark_lost(shelf)
    return done


def _take(shelf: Shelf, path: Path, done: Rebuilt) -> None:
    try:
        known = shelf.catalogue.get(path.name.removesuffix(RECORDING))
    except NoSuchRun:
        known = None
    if known is not None and known.is_going_on:
        return
    try:
        found = _record_in(path)
    except Unreadable as error:
        done.told.append(str(error))
        return
    shelf.catalogue.put(replace(found, **_written(shelf, found.id, known)))
    if known is None:
        done.added += 1
    else:
        done.renewed += 1


def _written(shelf: Shelf, id: str, known: RunRecord | None) -> dict[str, Any]:
    """What a person has written about the run: as the catalogue has it, else as it stands beside the recording."""
    if known is not None:
        return {name: getattr(known, name) for name in EDITED}
    return edits_beside(shelf.folder, id)


def _record_in(path: Path) -> RunRecord:
    """The run that a whole recording holds; raises `Unreadable`."""
    with Recording.open(path) as recording:
        if not recording.is_whole:
            raise Unreadable(f"{path} has no end; `pivotrig runs recover` mends it once nobody writes to it")
        return listed(path.name.removesuffix(RECORDING), recording)


def _mark_lost(shelf: Shelf) -> int:
    """Runs that had a recording which is not there any more."""
    lost = 0
    for id in shelf.catalogue.with_recording():
        if not file_of(shelf.folder, id).exists():
            shelf.catalogue.update(id, recording_state="lost", size_bytes=0)
            lost += 1
    return lost


def put_in_order(shelf: Shelf) -> str:
    """What a start has to do: deletions that were cut short, and a catalogue that has to be made anew.

    What was done, in words, if anything. Raises `CatalogueError`.
    """
    finish_deletions(shelf)
    if not shelf.catalogue.is_new or not any(shelf.folder.glob(f"*{RECORDING}")):
        return ""
    done = rebuild(shelf)
    broken = shelf.catalogue.put_aside
    why = (
        "there was no catalogue of runs"
        if broken is None
        else f"the catalogue of runs was damaged (kept as {broken.name})"
    )
    return "; ".join((f"{why}: it was made anew from {done.added + done.renewed} recordings", *done.told))
