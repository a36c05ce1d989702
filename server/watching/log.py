"""The program's log: words for people or one JSON object a line, to stderr or a file that is rotated.

Whoever logs waits for no disk: lines go through a queue to a thread of their own. Of lines that repeat themselves the
first ones are written, then how many there were.
"""

from __future__ import annotations

import json
import logging
import queue
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime
from logging.handlers import QueueHandler, QueueListener, RotatingFileHandler
from pathlib import Path
from typing import Any, Literal

from server.event_log import Event

FILE_BYTES = 5_000_000
FILES = 5
"""Rotated: five files of 5 MB, some weeks."""
WAITING = 10_000
"""Lines that may wait for a disk; more are dropped, and control does not notice."""
REPEATS = 20
"""Lines of one kind within the window that are written out."""
WINDOW = 10.0
"""s"""
KINDS = 500
"""Kinds of lines that are told apart."""

EVENTS = "pivotrig.events"
"""The logger of the event log's lines."""
LEVELS = {"info": logging.INFO, "warn": logging.WARNING, "error": logging.ERROR}
FIELDS = ("code", "severity", "run_id", "rig_time_s")
"""Of an event's line, beside what every line has."""

Level = Literal["debug", "info", "warning", "error"]


@dataclass(frozen=True, slots=True)
class LogChoice:
    """file: None for stderr."""

    as_json: bool = False
    file: Path | None = None
    level: Level = "warning"


class LogFileError(Exception):
    """The log cannot be written there; the text says why and what to do."""


def one_line(text: str) -> str:
    """Foreign text cannot make lines of its own or speak to a terminal."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)


class Words(logging.Formatter):
    """Time, level, logger and message; a traceback below it."""

    def format(self, record: logging.LogRecord) -> str:
        at = datetime.fromtimestamp(record.created).astimezone().isoformat(timespec="milliseconds")
        line = f"{at} {record.levelname.lower():<7} {record.name}: {one_line(record.getMessage())}"
        return f"{line}\n{self.formatException(record.exc_info)}" if record.exc_info else line


class Json(logging.Formatter):
    def format(self, record: logging.LogRecord) -> str:
        line: dict[str, Any] = {
            "at": datetime.fromtimestamp(record.created, UTC).isoformat(timespec="milliseconds"),
            "level": record.levelname.lower(),
            "logger": record.name,
            "message": record.getMessage(),
        }
        line.update({name: getattr(record, name) for name in FIELDS if hasattr(record, name)})
        if record.exc_info:
            line["traceback"] = self.formatException(record.exc_info)
        return json.dumps(line, default=str)


class Repeats(logging.Filter):
    """Lets the first lines of a kind pass, and after the window one that says how many there were."""

    def __init__(self) -> None:
        super().__init__()
        self._seen: dict[tuple[str, int, str], tuple[float, int]] = {}

    def filter(self, record: logging.LogRecord) -> bool:
        kind = (record.name, record.levelno, str(record.msg))
        since, count = self._seen.get(kind, (record.created, 0))
        if record.created - since > WINDOW:
            if count > REPEATS:
                record.msg = f"{record.getMessage()} (and {count - REPEATS} more of these before)"
                record.args = None
            since, count = record.created, 0
        if len(self._seen) >= KINDS:
            self._seen.clear()
        self._seen[kind] = (since, count + 1)
        return count < REPEATS


class Unwaiting(QueueHandler):
    """Drops a line when too many wait."""

    def enqueue(self, record: logging.LogRecord) -> None:
        try:
            self.queue.put_nowait(record)
        except queue.Full:
            return

    def prepare(self, record: logging.LogRecord) -> logging.LogRecord:
        """As it is: it stays in this process."""
        return record


@contextmanager
def logging_to(choice: LogChoice) -> Iterator[None]:
    """While the program runs, everything that it and its libraries say goes there; raises `LogFileError`."""
    target = handler_of(choice)
    target.setFormatter(Json() if choice.as_json else Words())
    waiting: queue.Queue[logging.LogRecord] = queue.Queue(WAITING)
    inlet = Unwaiting(waiting)
    inlet.addFilter(Repeats())
    listener = QueueListener(waiting, target)
    root = logging.getLogger()
    before = root.level
    root.setLevel(choice.level.upper())
    root.addHandler(inlet)
    listener.start()
    try:
        yield
    finally:
        root.removeHandler(inlet)
        root.setLevel(before)
        listener.stop()
        target.close()


def handler_of(choice: LogChoice) -> logging.Handler:
    if choice.file is None:
        return logging.StreamHandler(sys.stderr)
    try:
        choice.file.parent.mkdir(parents=True, exist_ok=True)
        return RotatingFileHandler(choice.file, maxBytes=FILE_BYTES, backupCount=FILES - 1, encoding="utf-8")
    except OSError as error:
        raise LogFileError(
            f"cannot write the log to {choice.file}: {error.strerror}; choose another with --log-file"
        ) from error


def log_event(event: Event) -> None:
    """A line of the rig's own event log becomes one of the program's."""
    about = {
        "code": event.code,
        "severity": str(event.severity),
        "run_id": event.run_id or None,
        "rig_time_s": round(event.time, 4),
    }
    logging.getLogger(EVENTS).log(
        LEVELS.get(str(event.severity), logging.INFO), "%s", event.message, extra=about
    )
