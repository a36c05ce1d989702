"""The table as plain CSV: a header with the names, one row a tick, empty where something is unknown.

Numbers have the fewest digits that give the same double back.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable
from typing import BinaryIO

from server.exports.columns import COLUMNS, Value
from server.exports.formats import Job, Watch
from server.exports.table import batches
from server.recording.reading.recording import Recording


def write(recording: Recording, sink: BinaryIO, _job: Job, watch: Watch) -> None:
    sink.write(_lines([[column.name for column in COLUMNS]]))
    for rows in batches(recording, COLUMNS, watch):
        sink.write(_lines(rows))


def _lines(rows: Iterable[Iterable[Value]]) -> bytes:
    text = io.StringIO(newline="")
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue().encode()
