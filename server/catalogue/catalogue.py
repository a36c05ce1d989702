"""The catalogue of all runs: one SQLite file in the data folder, for several threads and several programs."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from datetime import datetime
from itertools import islice
from pathlib import Path
from typing import Any

from sqlalchemy import delete, func, not_, or_, select, update
from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session

from server.catalogue.errors import CatalogueError, NoSuchRun
from server.catalogue.opening import NAME, Opened, opened
from server.catalogue.queries import next_cursor, number_of, place_at, places
from server.catalogue.records import EVERY_RUN, RUNNING, Loose, Page, RunQuery, RunRecord, Totals
from server.catalogue.rows import assign, record_of, row_of
from server.catalogue.sessions import Sessions
from server.catalogue.study_list import StudyList
from server.catalogue.tables import SHOWN, RunRow, SettingsRow

PAGE = 50
"""Runs on one page unless asked otherwise."""
ADDED_KEPT = 1000
"""Newest runs of which it is known that they were added here: as many as a session lists."""
ASKED_AT_ONCE = 10_000
"""Ids in one question; SQLite takes some 32 000."""


class Catalogue:
    """Every method raises `CatalogueError`, in words, where the file does not allow what is asked."""

    def __init__(self, path: Path, opened: Opened) -> None:
        self._sessions = Sessions(path, opened)
        self.studies = StudyList(self._sessions)
        self._added: deque[tuple[int, str]] = deque(maxlen=ADDED_KEPT)

    @property
    def path(self) -> Path:
        return self._sessions.path

    @property
    def is_new(self) -> bool:
        """There was none, or a broken one: recordings that are there are not in it yet."""
        return self._sessions.opened.is_new

    @property
    def exchanges(self) -> int:
        """How often another file has taken the place of the one that was opened."""
        return self._sessions.exchanges

    @property
    def put_aside(self) -> Path | None:
        """Where a broken one is now."""
        return self._sessions.opened.put_aside

    @classmethod
    def open(cls, data: Path) -> Catalogue:
        """That of a data folder, made where there is none; one that cannot be written to can still be read."""
        return cls(data / NAME, opened(data))

    def close(self) -> None:
        self._sessions.close()

    # One run -------------------------------------------------------------------------------------

    def add(self, record: RunRecord) -> None:
        """A new run."""
        try:
            with self._sessions.changing() as session:
                _put(session, record)
        except IntegrityError as error:
            raise CatalogueError(f"there is a run {record.id!r} already") from error
        self._added.append((self._sessions.exchanges, record.id))

    def renew(self, id: str, make: Callable[[RunRecord | None], RunRecord | None]) -> None:
        """Put another record in the place of one, or of none; one that is being deleted is let go.

        make: is given what is there, and makes what is to be there, or None where nothing is to change; meanwhile
        nobody else changes anything.
        """
        with self._sessions.changing() as session:
            row = session.get(RunRow, id)
            if row is not None and row.deleting:
                return
            record = make(None if row is None else _whole(session, row))
            if record is None:
                return
            session.expunge_all()
            session.execute(delete(RunRow).where(RunRow.id == id))
            _put(session, record)

    def update(self, id: str, **changes: Any) -> RunRecord:
        """Other values for some fields of a run; the run as it is then, without its settings."""
        with self._sessions.changing() as session:
            row = _row(session, id)
            assign(row, changes)
            if "settings" in changes:
                session.merge(SettingsRow(run_id=id, settings=changes["settings"]))
            return record_of(row)

    def get(self, id: str) -> RunRecord:
        """One run with its settings; raises `NoSuchRun`."""
        with self._sessions.reading() as session:
            return _whole(session, _row(session, id))

    def delete(self, id: str) -> None:
        """Take the row away; what is on the disk is `server.catalogue.deleting`'s."""
        with self._sessions.changing() as session:
            if session.connection().execute(delete(RunRow).where(RunRow.id == id)).rowcount == 0:
                raise NoSuchRun(id)

    def edit(self, id: str, changes: Mapping[str, Any], keep: Callable[[RunRecord], None]) -> RunRecord:
        """`update` by a person. keep: called before it counts; when that raises, nothing is changed."""
        with self._sessions.changing() as session:
            row = _row(session, id)
            assign(row, changes)
            record = record_of(row)
            keep(record)
            return record

    def hide(self, id: str, allow: Callable[[RunRecord], None]) -> RunRecord:
        """From now on nobody sees this run; its recording is about to go. allow: raises where that may not be."""
        with self._sessions.changing() as session:
            row = _row(session, id)
            record = record_of(row)
            allow(record)
            row.deleting = True
            return record

    def show_again(self, id: str) -> None:
        """A hidden run whose recording did not go."""
        with self._sessions.changing() as session:
            session.execute(update(RunRow).where(RunRow.id == id).values(deleting=False))

    def hidden(self) -> list[str]:
        """Runs whose recordings were about to go when something came between."""
        with self._sessions.reading() as session:
            return list(session.scalars(select(RunRow.id).where(RunRow.deleting.is_(True))))

    def going_on(self) -> list[str]:
        """Runs that walk or are being recorded, or did when their program ended."""
        is_going_on = or_(RunRow.state == RUNNING, RunRow.recording_state == "writing")
        with self._sessions.reading() as session:
            return list(session.scalars(select(RunRow.id).where(is_going_on, RunRow.deleting.is_(False))))

    # Many runs -----------------------------------------------------------------------------------

    def page(self, query: RunQuery = EVERY_RUN, cursor: str | None = None, limit: int = PAGE) -> Page:
        """Newest first; raises `BadCursor`."""
        after = None if cursor is None else place_at(cursor)
        with self._sessions.reading() as session:
            found = session.execute(places(query, after, limit + 1)).all()
            if after is not None:
                total = after.total
            elif len(found) <= limit:
                total = len(found)
            else:
                total = session.scalar(number_of(query, found)) or 0
            runs = _records(session, [id for _, id in found[:limit]])
        return Page(tuple(runs), next_cursor(runs, total) if len(found) > limit else None, total)

    def known(self, ids: Collection[str]) -> set[str]:
        """Those of the ids that are in the catalogue, hidden ones too."""
        with self._sessions.reading() as session:
            return {
                id
                for some in batched(ids, ASKED_AT_ONCE)
                for id in session.scalars(select(RunRow.id).where(RunRow.id.in_(some)))
            }

    def gone(self, ids: Collection[str]) -> set[str]:
        """Those of the ids that were added here and that somebody has deleted since."""
        added = {id for exchanges, id in self._added if exchanges == self._sessions.exchanges}.intersection(
            ids
        )
        return added - self.known(added)

    def beginning_with(self, prefix: str, limit: int) -> list[str]:
        """Ids that begin like that, newest first; all ids for an empty prefix."""
        runs = select(RunRow.id).where(SHOWN)
        if prefix:
            runs = runs.where(RunRow.id.startswith(prefix, autoescape=True))
        newest = runs.order_by(RunRow.started_at.desc(), RunRow.id.desc())
        with self._sessions.reading() as session:
            return list(session.scalars(newest.limit(limit)))

    def with_recording(self) -> list[str]:
        """Runs that are over and should have a file."""
        kept = RunRow.recording_state.in_(("complete", "recovered"))
        with self._sessions.reading() as session:
            return list(session.scalars(select(RunRow.id).where(SHOWN, kept)))

    def loose(self, before: datetime | None = None) -> list[Loose]:
        """All that may be deleted, oldest first. before: only what was started earlier."""
        going_on = or_(RunRow.state == RUNNING, RunRow.recording_state == "writing")
        wanted = select(RunRow.id, RunRow.label, RunRow.started_at, RunRow.size_bytes)
        wanted = wanted.where(SHOWN, RunRow.pinned.is_(False), not_(going_on))
        if before is not None:
            wanted = wanted.where(RunRow.started_at < before)
        with self._sessions.reading() as session:
            return [Loose(*found) for found in session.execute(wanted.order_by(RunRow.started_at, RunRow.id))]

    def totals(self) -> Totals:
        of_all = select(func.count(), func.sum(RunRow.size_bytes)).where(SHOWN)
        of_pinned = select(func.sum(RunRow.size_bytes)).where(SHOWN, RunRow.pinned.is_(True))
        with self._sessions.reading() as session:
            runs, size = session.execute(of_all).one()
            return Totals(runs, size or 0, session.scalar(of_pinned) or 0)


def _put(session: Session, record: RunRecord) -> None:
    session.add(row_of(record))
    session.flush()
    session.add(SettingsRow(run_id=record.id, settings=record.settings))


def _whole(session: Session, row: RunRow) -> RunRecord:
    """With its settings."""
    settings = session.get(SettingsRow, row.id)
    return record_of(row, None if settings is None else settings.settings)


def _row(session: Session, id: str) -> RunRow:
    row = session.get(RunRow, id)
    if row is None or row.deleting:
        raise NoSuchRun(id)
    return row


def _records(session: Session, ids: Collection[str]) -> list[RunRecord]:
    rows = {row.id: row for row in session.scalars(select(RunRow).where(RunRow.id.in_(ids)))}
    return [record_of(rows[id]) for id in ids]


def batched(ids: Iterable[str], size: int) -> Iterator[list[str]]:
    left = iter(ids)
    while some := list(islice(left, size)):
        yield some
