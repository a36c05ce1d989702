"""Connections to the catalogue's file, of whatever kind its folder allows."""

from __future__ import annotations

import json
import sqlite3
from contextlib import closing
from enum import Enum
from functools import partial
from pathlib import Path
from typing import Any

from sqlalchemy import Connection, Engine, create_engine, event
from sqlalchemy.dialects.sqlite.base import SQLiteDialect
from sqlalchemy.pool import ConnectionPoolEntry, NullPool, QueuePool
from sqlalchemy.schema import CreateTable

from server.catalogue.tables import Base
from server.catalogue.words import primary_code

BUSY = 3.0
"""How long a write waits for another program's, s; none of ours takes longer than some 10 ms."""
FOR_WRITING = {"writes": True}
"""Execution options of a connection that will write: it takes its place at once, instead of failing half-way."""
OUT_OF_REACH = (sqlite3.SQLITE_READONLY, sqlite3.SQLITE_CANTOPEN, sqlite3.SQLITE_PERM, sqlite3.SQLITE_AUTH)


class Access(Enum):
    """What the folder allows. NOTHING: there is no catalogue, and none can be made."""

    WRITE = "rwc"
    READ = "ro"
    READ_ALONE = "ro&immutable=1"
    NOTHING = "memory"


def access_of(path: Path) -> Access:
    """How a catalogue at `path` can be opened: only the attempt tells. Raises sqlite3.Error for a broken one."""
    for access in (Access.WRITE, Access.READ, Access.READ_ALONE):
        if access is not Access.WRITE and not path.exists():
            break
        if _can(path, access):
            return access
    return Access.NOTHING


def _can(path: Path, access: Access) -> bool:
    try:
        with closing(connect(path, access)) as connection:
            connection.execute("SELECT count(*) FROM sqlite_master").fetchone()
            if access is Access.WRITE:
                connection.execute("BEGIN IMMEDIATE")
                connection.execute("ROLLBACK")
    except sqlite3.OperationalError as error:
        if primary_code(error) in OUT_OF_REACH:
            return False
        raise
    return True


def connect(path: Path, access: Access) -> sqlite3.Connection:
    """A connection that begins and ends its transactions when it is told to, in any thread."""
    place = ":memory:" if access is Access.NOTHING else f"{path.absolute().as_uri()}?mode={access.value}"
    return sqlite3.connect(place, uri=True, timeout=BUSY, check_same_thread=False, isolation_level=None)


def engine_of(path: Path, access: Access, *, references: bool = True) -> Engine:
    """Each thread that asks has a connection of its own. Its file is not mapped: a disk that goes would end us.

    references: rows that belong to another go with it. Not while tables are rebuilt: SQLite empties those first.
    """
    engine = create_engine(
        "sqlite://",
        creator=partial(connect, path, access),
        poolclass=NullPool if access is Access.NOTHING else QueuePool,
        json_serializer=_json,
    )
    event.listen(engine, "connect", partial(_set_up, access, references))
    event.listen(engine, "begin", _begin)
    return engine


def _json(value: Any) -> str:
    return json.dumps(value, ensure_ascii=False, allow_nan=False, separators=(",", ":"))


def _set_up(access: Access, references: bool, connection: sqlite3.Connection, _: ConnectionPoolEntry) -> None:
    if access is Access.WRITE:
        connection.execute("PRAGMA journal_mode = WAL")
    if access is Access.NOTHING:
        _make_tables(connection)
    connection.execute("PRAGMA synchronous = NORMAL")
    connection.execute(f"PRAGMA foreign_keys = {'ON' if references else 'OFF'}")
    if access is not Access.WRITE:
        connection.execute("PRAGMA query_only = ON")


def _make_tables(connection: sqlite3.Connection) -> None:
    """An empty catalogue in memory, for a folder in which there is none and none can be made."""
    for table in Base.metadata.sorted_tables:
        connection.execute(str(CreateTable(table).compile(dialect=SQLiteDialect())))


def _begin(connection: Connection) -> None:
    writes = connection.get_execution_options().get("writes", False)
    connection.exec_driver_sql("BEGIN IMMEDIATE" if writes else "BEGIN")
