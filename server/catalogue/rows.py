"""Between a record and its row."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import fields
from typing import Any, cast

from server.catalogue.records import RecordingState, RunRecord
from server.catalogue.searching import words_in
from server.catalogue.tables import RunRow, TagRow

ELSEWHERE = ("tags", "settings")
"""Fields that have tables of their own."""
PLAIN = tuple(field.name for field in fields(RunRecord) if field.name not in ELSEWHERE)


def row_of(record: RunRecord) -> RunRow:
    row = RunRow(deleting=False)
    assign(row, {name: getattr(record, name) for name in (*PLAIN, "tags")})
    return row


def assign(row: RunRow, changes: Mapping[str, Any]) -> None:
    """Put new values into a row. changes: by the names of `RunRecord`, but for id of a row that is there."""
    for name, value in changes.items():
        if name == "tags":
            row.tags = tag_rows(row, value)
        elif name in PLAIN:
            setattr(row, name, list(value) if name == "sparkline" else value)
        elif name != "settings":
            raise TypeError(f"a run has no field {name!r}")
    row.words = words_of(row)


def tag_rows(row: RunRow, tags: Iterable[str]) -> list[TagRow]:
    """Rows of the same tags are used again: one that went and came in the same instant would be there twice."""
    known = {each.tag: each for each in row.tags}
    rows = []
    for position, tag in enumerate(dict.fromkeys(tags)):
        kept = known.get(tag) or TagRow(tag=tag)
        kept.position = position
        rows.append(kept)
    return rows


def words_of(row: RunRow) -> str:
    tags = [each.tag for each in row.tags]
    return words_in(tags, row.id, row.label, row.controller, row.trajectory, row.notes)


def record_of(row: RunRow, settings: Mapping[str, Any] | None = None) -> RunRecord:
    values = {name: getattr(row, name) for name in PLAIN}
    values["sparkline"] = tuple(row.sparkline)
    values["recording_state"] = cast(RecordingState, row.recording_state)
    return RunRecord(**values, tags=tuple(each.tag for each in row.tags), settings=dict(settings or {}))
