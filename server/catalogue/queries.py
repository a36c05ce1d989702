"""From what is asked to what is looked up."""

from __future__ import annotations

import base64
import binascii
import json
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime

from sqlalchemy import ColumnElement, Row, Select, func, select, tuple_

from server.catalogue.errors import BadCursor
from server.catalogue.records import EVERY_RUN, Page, RunQuery, RunRecord
from server.catalogue.searching import EQUAL, FLAGS, line_of, searched
from server.catalogue.tables import SHOWN, RunRow


@dataclass(frozen=True, slots=True)
class Place:
    """Where a run stands in the list: newest first, and by id where two began at once.

    total: how many runs the list has, counted for its first page.
    """

    started_at: datetime
    id: str
    total: int


def cursor_of(place: Place) -> str:
    """The place as text that nobody needs to understand."""
    text = json.dumps([place.started_at.isoformat(), place.id, place.total])
    return base64.urlsafe_b64encode(text.encode()).decode().rstrip("=")


def next_cursor(runs: Sequence[RunRecord], total: int) -> str:
    """Of the page after these runs."""
    return cursor_of(Place(runs[-1].started_at, runs[-1].id, total))


def joined(page: Page, waiting: Iterable[RunRecord], cursor: str | None, limit: int) -> Page:
    """A page with the runs, not in the catalogue yet, that belong between its first and its last one."""
    after = None if cursor is None else place_at(cursor)
    more = list(waiting)
    first = None if after is None else (after.started_at, after.id)
    last = order(page.runs[-1]) if page.next is not None else None
    own = [
        run for run in more if (first is None or order(run) < first) and (last is None or order(run) > last)
    ]
    runs = sorted((*page.runs, *own), key=order, reverse=True)
    following = page.next if len(runs) <= limit else next_cursor(runs[:limit], page.total)
    return Page(tuple(runs[:limit]), following, page.total + len(more))


def order(run: RunRecord) -> tuple[datetime, str]:
    """Runs are listed by this, the largest first."""
    return run.started_at, run.id


def place_at(cursor: str) -> Place:
    """The place that a cursor stands for; raises `BadCursor`."""
    try:
        text = base64.urlsafe_b64decode(cursor.encode() + b"=" * (-len(cursor) % 4))
        started_at, id, total = json.loads(text)
        started = datetime.fromisoformat(started_at)
        str(id).encode()  # half a surrogate pair is no text that could be looked for
        place = Place(started.astimezone(UTC), str(id), max(0, int(total)))
    except (binascii.Error, ValueError, TypeError, OverflowError) as error:
        raise BadCursor("this cursor does not belong to this list; begin again without one") from error
    if started.tzinfo is None:
        raise BadCursor("this cursor has no time zone; begin again without one")
    return place


def conditions(query: RunQuery) -> Iterator[ColumnElement[bool]]:
    """What a run must fulfil to be found."""
    yield SHOWN
    columns = RunRow.__table__.c
    for name in EQUAL:
        if wanted := getattr(query, name):
            yield columns[name] == wanted
    for name in FLAGS:
        if (flag := getattr(query, name)) is not None:
            yield columns[name].is_(flag)
    if query.since is not None:
        yield RunRow.started_at >= query.since
    if query.until is not None:
        yield RunRow.started_at < query.until
    if query.tag:
        yield RunRow.words.contains(line_of(query.tag), autoescape=True)
    for word in searched(query.text):
        yield RunRow.words.contains(word, autoescape=True)


def places(query: RunQuery, after: Place | None, limit: int) -> Select[datetime, str]:
    """Newest first. after: the last run of the page before."""
    wanted = select(RunRow.started_at, RunRow.id).where(*conditions(query))
    if after is not None:
        wanted = wanted.where(older_than(after.started_at, after.id))
    return wanted.order_by(RunRow.started_at.desc(), RunRow.id.desc()).limit(limit)


def number_of(query: RunQuery, found: Sequence[Row[datetime, str]]) -> Select[int]:
    """How many runs there are. found: the first of them, which need not be looked for again."""
    if query == EVERY_RUN:
        return select(func.count()).select_from(RunRow).where(SHOWN)
    started_at, id = found[-1]
    older = select(len(found) + func.count()).select_from(RunRow)
    return older.where(*conditions(query), older_than(started_at, id))


def older_than(started_at: datetime, id: str) -> ColumnElement[bool]:
    return tuple_(RunRow.started_at, RunRow.id) < (started_at, id)
