"""One study of a data folder: its definition, what came of it so far, and the right to carry it on."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path

from control.studies.definition import StudyDefinition
from control.studies.table import StudyRow, StudyTable
from server.atomic_save import replace_file
from server.studies.condition import (
    PROGRAM_ENDED,
    Claim,
    Condition,
    StudyState,
    is_claimed,
    read_condition,
    write_condition,
)
from server.studies.definition_file import require_unchanged
from server.studies.errors import StudyStoreError
from server.studies.results_file import Book, Results, cannot_write, new_rows

RESULTS, TABLE, REPORT = "results.jsonl", "table.csv", "report"

Listed = Callable[["Study"], None]
"""Told of every change of a study's state, for who lists it."""


@dataclass(frozen=True, slots=True)
class Tally:
    """Runs that have a row, and those of them that failed."""

    done: int
    failed: int


class Study:
    """Nothing of its results is kept in memory; every answer is read from the disk, except while it is claimed."""

    def __init__(self, folder: Path, definition: StudyDefinition, listed: Listed) -> None:
        self.folder = folder
        self.definition = definition
        self._listed = listed
        self._carrying: Carrying | None = None

    @property
    def id(self) -> str:
        return self.folder.name

    @property
    def condition(self) -> Condition:
        """A study that says "running" while nobody carries it out was interrupted. Raises `NoSuchStudy`."""
        found = read_condition(self.folder)
        if found.state == "running" and not is_claimed(self.folder):
            return replace(found, state="interrupted", reason=PROGRAM_ENDED)
        return found

    @property
    def state(self) -> StudyState:
        return self.condition.state

    @property
    def reason(self) -> str:
        return self.condition.reason

    @property
    def is_complete(self) -> bool:
        """Finished, and all its rows are still there."""
        return self.state == "finished" and not self.definition.plan().next(self.results())

    @property
    def created_at(self) -> datetime:
        return self.condition.created

    @property
    def report_folder(self) -> Path:
        return self.folder / REPORT

    def results(self) -> Results:
        """All rows by their run's index, read one at a time."""
        return self._carrying.done if self._carrying is not None else Results(self._path)

    def rows(self) -> list[StudyRow]:
        """All rows by index."""
        return sorted(self.results().rows(), key=lambda row: row.index)

    def new_rows(self, start: int) -> tuple[list[StudyRow], int]:
        """Rows that were written behind the byte `start`, and where to go on the next time."""
        return new_rows(self._path, start)

    def tally(self) -> Tally:
        results = self.results()
        return Tally(len(results), results.failed)

    def table(self) -> StudyTable:
        return StudyTable(self.definition.axis_names, self.results().rows())

    def write_table(self) -> Path:
        """The table as CSV in the study's folder; raises `StudyStoreError`."""
        path = self.folder / TABLE
        try:
            replace_file(path, self.table().csv().decode())
        except OSError as error:
            raise cannot_write(path, error) from error
        return path

    def append(self, row: StudyRow) -> None:
        """While it is claimed; returns when the row is safe on the disk."""
        if self._carrying is None:
            raise StudyStoreError(
                f"the study {self.definition.name!r} takes rows from who carries it out only"
            )
        self._carrying.append(row)

    @contextmanager
    def claimed(self) -> Iterator[Carrying]:
        """The right to add rows, for one process and one thread at a time. Raises `StudyBusy`, `StudyStoreError`.

        Its state is "running" meanwhile, and "interrupted" at the end, unless `Carrying.ends` has said another.
        """
        claim = Claim(self.folder, self.definition.name)
        try:
            before = read_condition(self.folder)
            require_unchanged(self.folder, before.definition)
            carrying = Carrying(Book(self._path), before)
            try:
                self._carrying = carrying
                self._become(replace(carrying.before, state="running", reason=""))
                yield carrying
            finally:
                self._carrying = None
                carrying.close()
                self._become(carrying.after)
        finally:
            claim.release()

    def _become(self, condition: Condition) -> None:
        write_condition(self.folder, condition)
        self._listed(self)

    @property
    def _path(self) -> Path:
        return self.folder / RESULTS


class Carrying:
    """A study while somebody carries it out. before: in which condition it was; failed runs that ended it count no
    more."""

    def __init__(self, book: Book, before: Condition) -> None:
        pardoned = len(book.done) if before.state == "failed" else before.pardoned
        self.before = replace(before, pardoned=pardoned)
        self._book = book
        self._began = time.monotonic()
        self._state: StudyState = "interrupted"
        self._reason = PROGRAM_ENDED

    @property
    def done(self) -> Results:
        return self._book.done

    def append(self, row: StudyRow) -> None:
        self._book.append(row)

    def extend(self, rows: Sequence[StudyRow]) -> None:
        """Several rows, and one wait for the disk."""
        self._book.extend(rows)

    def ends(self, state: StudyState, reason: str = "") -> None:
        """In which state it is left."""
        self._state, self._reason = state, reason

    @property
    def wall(self) -> float:
        """How long it has been worked on, all sittings together, s."""
        return self.before.wall_s + time.monotonic() - self._began

    @property
    def after(self) -> Condition:
        return replace(self.before, state=self._state, reason=self._reason, wall_s=round(self.wall, 3))

    def close(self) -> None:
        self._book.close()
