"""A catalogue is opened: made where there is none, brought up to date, put aside where it is broken."""

from __future__ import annotations

import contextlib
import fcntl
import os
import sqlite3
import time
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from sqlalchemy import Connection, Engine, inspect, text
from sqlalchemy.exc import DBAPIError, SQLAlchemyError

from server.catalogue.database import BUSY, FOR_WRITING, Access, access_of, engine_of
from server.catalogue.errors import CatalogueError
from server.catalogue.tables import REVISIONS, VERSION, Base
from server.catalogue.words import in_words, is_broken, is_busy

NAME = "catalogue.sqlite"
SIDE_FILES = ("-wal", "-shm")
"""What SQLite keeps beside its file."""
AGAIN = 0.02
"""A catalogue that another program is just making is tried again after this long, s."""
CHECKED_WHOLE = 8 << 20
"""A catalogue of up to this many bytes is checked whole when it is opened, which takes some 10 ms."""


class NotACatalogue(Exception):
    """The file is something else, or damaged; the text says what."""


@dataclass(frozen=True, slots=True)
class Opened:
    """is_new: there was no catalogue, or a broken one.  put_aside: where a broken one is now."""

    engine: Engine
    access: Access
    is_new: bool
    put_aside: Path | None = None


def opened(data: Path) -> Opened:
    """The catalogue of a data folder; raises `CatalogueError`."""
    path = data / NAME
    try:
        data.mkdir(parents=True, exist_ok=True)
        return _opened_in_turn(path)
    except NotACatalogue:
        return _opened_anew(path)
    except OSError as error:
        raise CatalogueError(
            f"the data folder {data} cannot be used: {error.strerror}; choose another with --data"
        ) from error
    except (sqlite3.Error, SQLAlchemyError) as error:
        raise CatalogueError(in_words(error, path)) from error


def _opened_in_turn(path: Path) -> Opened:
    """Several programs that make a catalogue at the same instant are refused by SQLite without being waited for."""
    give_up = time.monotonic() + BUSY
    while True:
        try:
            return _opened(path)
        except (sqlite3.OperationalError, SQLAlchemyError) as error:
            if not is_busy(error) or time.monotonic() > give_up:
                raise
        time.sleep(AGAIN)


def _opened_anew(path: Path) -> Opened:
    """A broken catalogue is kept under another name, for whoever wants to look at it."""
    try:
        with _alone(path.parent):
            return _exchanged(path)
    except (OSError, NotACatalogue, sqlite3.Error, SQLAlchemyError) as error:
        raise CatalogueError(
            f"the catalogue {path} is damaged and cannot be put aside ({error}); choose another folder with --data"
        ) from error


@contextlib.contextmanager
def _alone(folder: Path) -> Iterator[None]:
    """Of several programs that find a broken catalogue one puts it aside; the others find that it has been done."""
    number = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        fcntl.flock(number, fcntl.LOCK_EX)
        yield
    finally:
        os.close(number)


def _exchanged(path: Path) -> Opened:
    try:
        return _opened_in_turn(path)
    except NotACatalogue:
        aside = path.with_name(f"{NAME}.broken-{datetime.now():%Y%m%d-%H%M%S-%f}")
        for side in (
            *SIDE_FILES,
            "",
        ):  # its own name last: from then on another program may make a new one there
            if os.path.exists(f"{path}{side}"):
                os.replace(f"{path}{side}", f"{aside}{side}")
    fresh = _opened_in_turn(path)
    return Opened(fresh.engine, fresh.access, is_new=True, put_aside=aside)


def _opened(path: Path) -> Opened:
    try:
        access = access_of(path)
    except sqlite3.DatabaseError as error:
        raise _judged(error) from error
    engine = engine_of(path, access)
    try:
        is_new = access is not Access.NOTHING and _is_made_ready(engine, path, access)
    except BaseException as error:
        engine.dispose()
        cause = error.orig if isinstance(error, DBAPIError) else error
        raise (_judged(cause) if isinstance(cause, sqlite3.Error) else error) from error
    return Opened(engine, access, is_new)


def _judged(error: sqlite3.Error) -> Exception:
    return NotACatalogue(str(error)) if is_broken(error) else error


def _is_made_ready(engine: Engine, path: Path, access: Access) -> bool:
    """Bring the tables into this program's layout; whether there were none before."""
    with engine.connect() as connection:
        version = version_in(connection)
        if path.stat().st_size <= CHECKED_WHOLE:
            _check(connection)
    if version == VERSION:
        return False
    if access is not Access.WRITE:
        raise CatalogueError(f"the catalogue {path} has an older layout and its folder cannot be written to")
    laying = engine_of(path, access, references=False)
    try:
        with laying.execution_options(**FOR_WRITING).begin() as connection:
            return _brought_up_to_date(connection, path)
    finally:
        laying.dispose()


def _check(connection: Connection) -> None:
    finding = connection.execute(text("PRAGMA quick_check(1)")).scalar_one()
    if finding != "ok":
        raise NotACatalogue(str(finding))


def version_in(connection: Connection) -> str | None:
    """Which layout the tables have, None for an empty file; raises `NotACatalogue` for another program's."""
    names = inspect(connection).get_table_names()
    if not names:
        return None
    if "alembic_version" not in names:
        raise NotACatalogue(f"it has other tables: {', '.join(names[:5])}")
    return connection.execute(text("SELECT version_num FROM alembic_version")).scalar_one()


def _brought_up_to_date(connection: Connection, path: Path) -> bool:
    """Whether it was empty. What another program does at the same time waits, and finds it done."""
    version = version_in(connection)
    if version is None:
        make(connection)
        return True
    if version not in REVISIONS:
        raise CatalogueError(
            f"the catalogue {path} has been written by a newer pivotrig (its layout is {version[:40]!r}, "
            f"this program knows {VERSION!r}); update pivotrig, or choose another folder with --data"
        )
    if version != VERSION:
        from server.catalogue.migrations.upgrade import (
            upgrade,
        )  # Alembic: half a second that is seldom needed

        upgrade(connection)
    return False


def make(connection: Connection) -> None:
    """All tables, in the newest layout: the same as all migrations together give."""
    Base.metadata.create_all(connection)
    connection.execute(text("CREATE TABLE alembic_version (version_num VARCHAR(32) NOT NULL PRIMARY KEY)"))
    connection.execute(text("INSERT INTO alembic_version VALUES (:version)"), {"version": VERSION})
