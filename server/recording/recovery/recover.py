"""What a program that was killed leaves behind: torn recordings are made whole, and runs that went on are ended.

A recording is torn when it has no end and nobody holds its lock. The whole copy is made beside it, and takes its
place when it is on the disk; so a recovery that is killed itself has changed nothing, and the next one begins anew.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from server.catalogue.errors import CatalogueError, NoSuchRun
from server.catalogue.records import RUNNING
from server.catalogue.shelf import RECORDING, TORN, WALKING, file_of
from server.recording.names import SETTINGS
from server.recording.reading.byte_source import ByteSource, Damaged
from server.recording.reading.finding import has_end, look_through
from server.recording.reading.listing import listed
from server.recording.reading.recording import Recording, Unreadable
from server.recording.recovery.recovered_rows import end_row, put_recovered, put_torn
from server.recording.recovery.repair import Repair
from server.recording.writing.disk import LocalDisk, sync_folder

if TYPE_CHECKING:
    from server.catalogue.catalogue import Catalogue


@dataclass(frozen=True, slots=True)
class Recovered:
    """What was done about one run. said: a sentence for people.  is_recovered: its recording is whole again."""

    id: str
    said: str
    is_recovered: bool = False

    def __str__(self) -> str:
        return self.said


def recover(
    folder: Path, catalogue: Catalogue, between: Callable[[], None] = lambda: None
) -> list[Recovered]:
    """Everything in a folder of recordings; what cannot be done now is said, and tried again the next time.

    between: called after each quarter second that was copied, for a rig that walks meanwhile.
    Raises `CatalogueError` when the catalogue cannot be read.
    """
    done: list[Recovered] = []
    for path in sorted(folder.glob(f"*{RECORDING}")):
        with torn(path) as source:
            if source is not None:
                done.append(_recovered(path, source, catalogue, between))
    told = {each.id for each in done}
    return done + [each for each in _ended_rows(folder, catalogue) if each.id not in told]


@contextlib.contextmanager
def torn(path: Path) -> Iterator[ByteSource | None]:
    """The file, if it is torn; nobody else has it as long as the context lasts.

    A recorder locks its file before it writes the first byte, so an empty one may be about to be locked.
    """
    try:
        source = ByteSource(path)
    except OSError:  # deleted since its name was read, or not ours to read
        yield None
        return
    with source:
        is_torn = source.size > 0 and not has_end(source) and _is_free(source) and _is_still(path, source)
        yield source if is_torn else None


def _is_free(source: ByteSource) -> bool:
    """Take the lock; False while somebody writes the file."""
    try:
        fcntl.flock(source.fileno(), fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True


def _is_still(path: Path, source: ByteSource) -> bool:
    """Nobody went on with it, replaced or deleted it between the look and the lock."""
    try:
        now = path.stat()
    except OSError:
        return False
    return os.path.samestat(now, os.fstat(source.fileno())) and now.st_size == source.size


def _recovered(
    path: Path, source: ByteSource, catalogue: Catalogue, between: Callable[[], None]
) -> Recovered:
    id, new = path.name.removesuffix(RECORDING), path.with_name(f".{path.name}.repairing")
    try:
        repair = _copied(source, new, _ended(catalogue, id), between)
        with Recording.open(new) as whole:
            record = listed(id, whole)
        if not _is_still(path, source):
            new.unlink()
            return Recovered(id, f"run {id} was deleted while its recording was being recovered")
        trouble = _trouble(lambda: put_recovered(catalogue, path.parent, record))
        os.replace(new, path)
        sync_folder(path.parent)
    except Damaged as error:
        return _set_aside(path, catalogue, error)
    except (OSError, Unreadable) as error:
        with contextlib.suppress(OSError):
            new.unlink(missing_ok=True)
        return Recovered(
            id, f"the torn recording of run {id} could not be recovered ({error}); it is as it was"
        )
    left_out = f" ({repair.left_out} damaged pieces were left out)" if repair.left_out else ""
    said = f"the torn recording of run {id} was recovered: {whole.duration:.1f} s{left_out}{trouble}"
    return Recovered(id, said, is_recovered=True)


def _copied(
    source: ByteSource, new: Path, ended: dict[str, Any] | None, between: Callable[[], None]
) -> Repair:
    """Raises `Damaged` where there is nothing to copy, OSError where the disk does not take it."""
    contents = look_through(source)
    if not contents.chunks and SETTINGS not in {place.name for place in contents.attachments}:
        raise Damaged("it ends before the settings of its run")
    new.unlink(missing_ok=True)  # of a recovery that was killed
    file = LocalDisk().create(new)
    try:
        repair = Repair(source, contents, file, ended)
        repair.copy(between)
        file.sync()
    finally:
        file.close()
    return repair


def _ended(catalogue: Catalogue, id: str) -> dict[str, Any] | None:
    """How the run ended, if the catalogue knows: then only the end of its recording is missing."""
    try:
        record = catalogue.get(id)
    except CatalogueError:
        return None
    if record.state == RUNNING or record.ended_at is None:
        return None
    return {
        "state": record.state,
        "reason": record.reason,
        "metrics": record.metrics,
        "ended_at": record.ended_at.isoformat(),
    }


def _set_aside(path: Path, catalogue: Catalogue, error: Damaged) -> Recovered:
    """A file of which nothing can be read is kept under another name."""
    id = path.name.removesuffix(RECORDING)
    kept = file_of(path.parent, id, TORN)
    try:
        os.replace(path, kept)
    except OSError as trouble:
        return Recovered(id, f"nothing of the recording {path} can be read: {error} ({trouble.strerror})")
    said = _trouble(lambda: put_torn(catalogue, id, kept.stat().st_size))
    return Recovered(
        id, f"nothing of the recording of run {id} can be read: {error}; it is kept as {kept}{said}"
    )


def _trouble(change: Callable[[], None]) -> str:
    """What the catalogue says against a change; a recording is recovered all the same."""
    try:
        change()
    except CatalogueError as error:
        return f"; but {error}"
    return ""


def _ended_rows(folder: Path, catalogue: Catalogue) -> Iterator[Recovered]:
    """Runs that were going on, and that nobody walks any more."""
    for id in catalogue.going_on():
        path, walking = file_of(folder, id), file_of(folder, id, WALKING)
        if is_being_written(path) or is_being_written(walking):
            continue
        try:
            record = catalogue.get(id)  # its program writes how it has ended before it lets the lock go
        except NoSuchRun:
            continue
        if record.is_going_on:
            said = _trouble(lambda path=path, record=record: end_row(catalogue, path, record))
            what = (
                "was interrupted"
                if record.state == RUNNING
                else "has ended, and its recording was not listed"
            )
            yield Recovered(id, f"run {id} {what}{said}")
        with contextlib.suppress(OSError):
            walking.unlink(missing_ok=True)


def is_being_written(path: Path) -> bool:
    """Whether the program that walks the run, of all programs, holds the file."""
    try:
        source = ByteSource(path)
    except OSError:
        return False
    with source:
        return not _is_free(source)
