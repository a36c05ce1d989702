"""The table for MATLAB and Octave: one variable a column, NaN where something is unknown, words as cells.

Beside the columns there are `units` and `descriptions` (structs of the columns' names), `settings` and `outcome`.
"""

from __future__ import annotations

import math
import re
import tempfile
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray
from scipy.io import savemat

from server.exports.columns import COLUMNS, Column, Kind
from server.exports.formats import ExportError, Job, Watch
from server.exports.table import batches
from server.recording.reading.recording import Recording

VARIABLE_LIMIT = 1 << 31
"""Bytes that a variable of a MAT file of version 5 may have."""
CELL_SIZE = 72
"""Bytes that a cell with a short word takes, before compression (measured)."""
NAME_LENGTH = 63
"""Characters that MATLAB takes of a name."""
DEPTH = 30
"""Levels of the settings that are kept as structs; they have about six."""


def write(recording: Recording, sink: BinaryIO, _job: Job, watch: Watch) -> None:
    with tempfile.TemporaryFile() as spool, tempfile.TemporaryFile() as file:
        words = [_Words() for _ in COLUMNS]
        rows = _spool(recording, spool, words, watch)
        variables = _variables(_columns(spool, rows), words)
        contents = {**variables, **_about(recording)}
        savemat(file, contents, do_compression=True, oned_as="column", long_field_names=True)
        _hand_over(file, sink)


class _Words:
    """The different words of a column, each by its number; a run has few of them."""

    def __init__(self) -> None:
        self.numbers: dict[str, int] = {}

    def number(self, word: object) -> float:
        return math.nan if word is None else self.numbers.setdefault(str(word), len(self.numbers))

    def cells(self, numbers: NDArray[np.float64]) -> NDArray[np.object_]:
        """(n, 1) words; the empty word where one is unknown."""
        words = np.array([*self.numbers, ""], dtype=object)
        unknown = np.isnan(numbers)
        return words[np.where(unknown, len(self.numbers), numbers).astype(int)].reshape(-1, 1)


def _spool(recording: Recording, spool: BinaryIO, words: list[_Words], watch: Watch) -> int:
    """Put the table on the disk as float64, row by row, since it has to be written column by column; the rows."""
    count = 0
    for rows in batches(recording, COLUMNS, watch):
        values = [
            [
                _as_float(value, column, known)
                for value, column, known in zip(row, COLUMNS, words, strict=True)
            ]
            for row in rows
        ]
        spool.write(np.array(values, np.float64).tobytes())
        count += len(rows)
    if count * CELL_SIZE > VARIABLE_LIMIT:
        raise ExportError(
            f"{count} ticks are too many for a MAT file, whose variables end at 2 GB; take Parquet or CSV"
        )
    spool.flush()
    return count


def _as_float(value: Any, column: Column, words: _Words) -> float:
    if column.kind is Kind.WORD:
        return words.number(value)
    return math.nan if value is None else float(value)


def _columns(spool: BinaryIO, rows: int) -> NDArray[np.float64]:
    """(columns, rows), read from the disk where it is looked at."""
    shape = rows, len(COLUMNS)
    return (np.memmap(spool, np.float64, "r", shape=shape) if rows else np.empty(shape)).T


def _variables(columns: NDArray[np.float64], words: list[_Words]) -> dict[str, Any]:
    return {
        column.name: known.cells(values) if column.kind is Kind.WORD else values
        for column, values, known in zip(COLUMNS, columns, words, strict=True)
    }


def _about(recording: Recording) -> dict[str, Any]:
    return {
        "units": {column.name: column.unit for column in COLUMNS},
        "descriptions": {column.name: column.description for column in COLUMNS},
        "settings": _struct(recording.settings, DEPTH),
        "outcome": _struct(recording.outcome or {}, DEPTH),
    }


def _struct(value: Any, depth: int) -> Any:
    """JSON as MATLAB has it: structs, columns of numbers, cells; an empty array for null and for {}."""
    if isinstance(value, dict) and value and depth:
        return {_name(key): _struct(each, depth - 1) for key, each in value.items()}
    if isinstance(value, list) and value and depth:
        numbers = all(isinstance(each, int | float) for each in value)
        return np.array(value, float) if numbers else _cells([_struct(each, depth - 1) for each in value])
    if isinstance(value, bool | str | float):
        return value
    return float(value) if isinstance(value, int) else np.empty((0, 0))


def _cells(values: list[Any]) -> NDArray[np.object_]:
    cells = np.empty(len(values), object)
    cells[:] = values
    return cells


def _name(key: str) -> str:
    """A field's name as MATLAB allows it."""
    name = re.sub(r"\W", "_", key, flags=re.ASCII)
    return (name if name[:1].isalpha() else f"f_{name}")[:NAME_LENGTH]


def _hand_over(file: BinaryIO, sink: BinaryIO) -> None:
    """Copied at the end, since savemat goes back in what it writes and a sink cannot."""
    file.seek(0)
    while piece := file.read(1 << 20):
        sink.write(piece)
