"""The rows of one study on the disk: a line of JSON each, which is there whole or not at all.

A line counts once its newline is there; what a crash left of a last one is cut off when the next writer comes.
A whole line that makes no sense, after a bad disk, is a run that was not carried out.
"""

from __future__ import annotations

import contextlib
import json
import os
from array import array
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from control.studies.definition import MOST_RUNS
from control.studies.table import StudyRow
from server.studies.errors import StudyStoreError

NEWLINE = b"\n"
NOWHERE = -1
APPENDING = os.O_RDWR | os.O_CREAT | os.O_APPEND | os.O_CLOEXEC


class Results(Mapping[int, StudyRow]):
    """The rows of a file by their run's index. Only where each one stands is kept: 8 bytes a run.

    path: a file that is not there is an empty one.  end: bytes of whole lines that were read.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.end = 0
        self.failed = 0
        self._offsets = array("q")
        self._count = 0
        self.refresh()

    def __len__(self) -> int:
        return self._count

    def __iter__(self) -> Iterator[int]:
        return (index for index, offset in enumerate(self._offsets) if offset != NOWHERE)

    def __contains__(self, index: object) -> bool:
        return isinstance(index, int) and self._offset(index) != NOWHERE

    def __getitem__(self, index: int) -> StudyRow:
        offset = self._offset(index)
        if offset == NOWHERE:
            raise KeyError(index)
        with self.path.open("rb") as file:
            file.seek(offset)
            row = row_in(file.readline())
        if row is None:
            raise StudyStoreError(f"{self.path} was changed while it was read; try again")
        return row

    def rows(self) -> Iterator[StudyRow]:
        """All of them, as they were written, in one reading of the file."""
        for offset, _, row in lines(self.path, 0, self.end):
            if row is not None and self._offset(row.index) == offset:
                yield row

    def refresh(self) -> None:
        """Take in what was written since."""
        for offset, end, row in lines(self.path, self.end):
            self.note(offset, end, row)

    def note(self, offset: int, end: int, row: StudyRow | None) -> None:
        """A line stands there; a second row of the same run does not count."""
        self.end = end
        if row is None or row.index in self:
            return
        missing = row.index + 1 - len(self._offsets)
        if missing > 0:
            self._offsets.extend([NOWHERE] * missing)
        self._offsets[row.index] = offset
        self._count += 1
        self.failed += row.state == "failed"

    def _offset(self, index: int) -> int:
        return self._offsets[index] if 0 <= index < len(self._offsets) else NOWHERE


def lines(path: Path, start: int, end: int | None = None) -> Iterator[tuple[int, int, StudyRow | None]]:
    """Where each whole line begins and ends, bytes, and its row; None for one that makes no sense."""
    try:
        file = path.open("rb")
    except FileNotFoundError:
        return
    with file:
        file.seek(start)
        while (end is None or start < end) and (line := file.readline()).endswith(NEWLINE):
            yield start, start + len(line), row_in(line)
            start += len(line)


def new_rows(path: Path, start: int) -> tuple[list[StudyRow], int]:
    """What came behind the byte `start`, and where to go on the next time: for a reader in another process."""
    found = list(lines(path, start))
    rows = [row for _, _, row in found if row is not None]
    return rows, found[-1][1] if found else start


def row_in(line: bytes) -> StudyRow | None:
    """None for what is no row of any study."""
    try:
        row = StudyRow.from_json(json.loads(line))
    except (ValueError, TypeError, KeyError, RecursionError):
        return None
    return row if 0 <= row.index < MOST_RUNS else None


class Book:
    """The one writer of a results file. Raises `StudyStoreError` where the disk does not allow it."""

    def __init__(self, path: Path) -> None:
        try:
            self._number = os.open(path, APPENDING, 0o666)
        except OSError as error:
            raise cannot_write(path, error) from error
        try:
            self.done = Results(path)
            os.ftruncate(self._number, self.done.end)
        except OSError as error:
            os.close(self._number)
            raise cannot_write(path, error) from error

    def append(self, row: StudyRow) -> None:
        """Returns when the row is safe on the disk."""
        self.extend((row,))

    def extend(self, rows: Sequence[StudyRow]) -> None:
        """All of them at once: one wait for the disk."""
        written = [_line(row) for row in rows if row.index not in self.done]
        self._write(b"".join(line for line, _ in written))
        for line, row in written:
            self.done.note(self.done.end, self.done.end + len(line), row)

    def _write(self, data: bytes) -> None:
        rest = memoryview(data)
        try:
            while rest:
                rest = rest[os.write(self._number, rest) :]
            os.fsync(self._number)
        except OSError as error:
            with contextlib.suppress(OSError):  # else the next writer does it
                os.ftruncate(self._number, self.done.end)
            raise cannot_write(self.done.path, error) from error

    def close(self) -> None:
        os.close(self._number)


def _line(row: StudyRow) -> tuple[bytes, StudyRow]:
    text = json.dumps(row.to_json(), ensure_ascii=False, separators=(",", ":"))
    return text.encode() + NEWLINE, row


def cannot_write(path: Path, error: OSError) -> StudyStoreError:
    return StudyStoreError(
        f"{path} cannot be written: {error.strerror or error}; make room or give yourself the right to write "
        "there, then go on with `pivotrig studies resume`"
    )
