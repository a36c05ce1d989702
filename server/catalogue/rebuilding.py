"""The catalogue from the recordings: for a lost or broken one, and for recordings that came from elsewhere."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from server.catalogue.deleting import finish_deletions
from server.catalogue.edits import EDITED, edits_beside
from server.catalogue.errors import NoSuchRun
from server.catalogue.records import RunRecord
from server.catalogue.shelf import RECORDING, Shelf, file_of
from server.recording.reading.listing import listed
from server.recording.reading.recording import Recording, Unreadable
from server.recording.recovery.recover import is_being_written, recover

Watch = Callable[[int, int], None]
"""Told after each recording: how many have been read, and how many there are."""


@dataclass(slots=True)
class Rebuilt:
    """added: runs that were not in the catalogue.  renewed: read once more.  lost: whose recording is gone.

    studies: that are listed.  told: what was mended and what cannot be read, in words.
    """

    added: int = 0
    renewed: int = 0
    lost: int = 0
    studies: int = 0
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
    done.studies = _list_studies(shelf)
    return done


def _list_studies(shelf: Shelf) -> int:
    """Their folders lie beside that of the recordings; how many there are."""
    from server.studies.store import StudyStore

    return StudyStore(shelf.folder.parent, shelf.catalogue).relist()


def _take(shelf: Shelf, path: Path, done: Rebuilt) -> None:
    """One recording, unless its run goes on."""
    try:
        found = _record_in(path)
    except Unreadable as error:
        if not _goes_on(path):
            done.told.append(str(error))
        return

    def made(known: RunRecord | None) -> RunRecord | None:
        if known is None:
            was_deleted = not path.exists()
            done.added += not was_deleted
            return None if was_deleted else replace(found, **edits_beside(shelf.folder, found.id))
        if known.is_going_on:
            return None
        done.renewed += 1
        return replace(found, **_kept(known))

    shelf.catalogue.renew(found.id, made)


def _goes_on(path: Path) -> bool:
    """Somebody writes it, or has just made it; or it has just been deleted."""
    try:
        return path.stat().st_size == 0 or is_being_written(path)
    except OSError:
        return True


def _kept(known: RunRecord) -> dict[str, Any]:
    """What a recording does not know of its run: what a person has written, and the study that took it in later."""
    written = {name: getattr(known, name) for name in EDITED}
    return {**written, "study": known.study} if known.study else written


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
        if file_of(shelf.folder, id).exists():
            continue
        with contextlib.suppress(NoSuchRun):  # deleted since it was asked for
            shelf.catalogue.update(id, recording_state="lost", size_bytes=0)
            lost += 1
    return lost


def put_in_order(shelf: Shelf, watch: Watch = lambda _read, _all: None) -> str:
    """What a start has to do: deletions that were cut short, and recordings that the catalogue does not know.

    What was done, in words, if anything. Raises `CatalogueError`.
    """
    finish_deletions(shelf)
    _list_studies(shelf)
    if not shelf.catalogue.is_new:
        return _unlisted_added(shelf, watch)
    if not any(shelf.folder.glob(f"*{RECORDING}")):
        return ""
    done = rebuild(shelf, watch)
    broken = shelf.catalogue.put_aside
    why = (
        "there was no catalogue of runs"
        if broken is None
        else f"the catalogue of runs was damaged (kept as {broken.name})"
    )
    return "; ".join((f"{why}: it was made anew from {done.added + done.renewed} recordings", *done.told))


def _unlisted_added(shelf: Shelf, watch: Watch) -> str:
    """Recordings whose run could not be listed when it was walked, or by a catalogue that was lost since."""
    paths = {path.name.removesuffix(RECORDING): path for path in shelf.folder.glob(f"*{RECORDING}")}
    done = Rebuilt()
    unlisted = sorted(paths.keys() - shelf.catalogue.known(paths))
    for read, id in enumerate(unlisted, start=1):
        _take(shelf, paths[id], done)
        watch(read, len(unlisted))
    if not done.added:
        return ""
    number = "one recording was" if done.added == 1 else f"{done.added} recordings were"
    return f"{number} not in the catalogue of runs, and came into it"
