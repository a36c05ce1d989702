"""The table as Parquet: fields carry `unit` and `description`, the file carries `settings` and `outcome` as JSON."""

from __future__ import annotations

import json
from typing import BinaryIO

import pyarrow as pa
from pyarrow import parquet

from server.exports.columns import COLUMNS, Column, Kind
from server.exports.formats import Job, Watch
from server.exports.table import Row, batches
from server.recording.reading.recording import Recording

TYPES = {
    Kind.NUMBER: pa.float64(),
    Kind.COUNT: pa.int64(),
    Kind.FLAG: pa.bool_(),
    Kind.WORD: pa.string(),
}


def write(recording: Recording, sink: BinaryIO, _job: Job, watch: Watch) -> None:
    schema = pa.schema([_field(column) for column in COLUMNS], metadata=_about(recording))
    with parquet.ParquetWriter(sink, schema, compression="zstd") as writer:
        for rows in batches(recording, COLUMNS, watch):
            writer.write_batch(pa.record_batch(_arrays(rows), schema=schema))


def _field(column: Column) -> pa.Field:
    return pa.field(
        column.name,
        TYPES[column.kind],
        metadata={"unit": column.unit, "description": column.description},
    )


def _about(recording: Recording) -> dict[str, str]:
    return {
        "started_at": recording.started_at.isoformat(),
        "settings": json.dumps(recording.settings),
        "outcome": json.dumps(recording.outcome),
    }


def _arrays(rows: list[Row]) -> list[pa.Array]:
    values = zip(*rows, strict=True)
    return [pa.array(each, TYPES[column.kind]) for column, each in zip(COLUMNS, values, strict=True)]
