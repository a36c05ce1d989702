"""What SQLite complains of, in the words of the person who has to do something about it."""

from __future__ import annotations

import sqlite3
from pathlib import Path

from sqlalchemy.exc import SQLAlchemyError

BROKEN_CODES = (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB)

_SENTENCES = {
    sqlite3.SQLITE_BUSY: "another program has been writing to the catalogue {path} for some seconds; try again",
    sqlite3.SQLITE_LOCKED: "another program has been writing to the catalogue {path} for some seconds; try again",
    sqlite3.SQLITE_READONLY: "the catalogue {path} cannot be written to; "
    "give yourself the right to write to its folder, or choose another with --data",
    sqlite3.SQLITE_CANTOPEN: "the catalogue {path} cannot be opened; "
    "give yourself the right to write to its folder, or choose another with --data",
    sqlite3.SQLITE_FULL: "the disk of {path} is full, so nothing was changed; "
    "delete runs, or something else, and try again",
    sqlite3.SQLITE_IOERR: "the disk of {path} cannot be read or written ({error}); see what is wrong with it",
    sqlite3.SQLITE_CORRUPT: "the catalogue {path} is damaged; stop pivotrig and start it again: "
    "it puts the file aside and makes a new one from the recordings",
    sqlite3.SQLITE_NOTADB: "the catalogue {path} is damaged; stop pivotrig and start it again: "
    "it puts the file aside and makes a new one from the recordings",
}


def primary_code(error: sqlite3.Error) -> int:
    """SQLite's main result code; 0 for what did not come from SQLite itself."""
    return getattr(error, "sqlite_errorcode", 0) & 0xFF


def is_broken(error: sqlite3.Error) -> bool:
    """The file's content is wrong, as against one that is busy or out of reach."""
    return primary_code(error) in BROKEN_CODES


def is_busy(error: SQLAlchemyError | sqlite3.Error) -> bool:
    cause = getattr(error, "orig", error)
    return isinstance(cause, sqlite3.Error) and primary_code(cause) in (
        sqlite3.SQLITE_BUSY,
        sqlite3.SQLITE_LOCKED,
    )


def in_words(error: SQLAlchemyError | sqlite3.Error, path: Path) -> str:
    cause = getattr(error, "orig", error)
    code = primary_code(cause) if isinstance(cause, sqlite3.Error) else 0
    sentence = _SENTENCES.get(code, "the catalogue {path} cannot do that ({error})")
    return sentence.format(path=path, error=cause)
