"""A recording as rows, some thousand at a time, so that an hour takes no more memory than a minute."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from server.exports.columns import Column, Value, named
from server.exports.formats import Watch
from server.recording.reading.recording import Recording

AT_ONCE = 4096
"""Ticks of one batch: a minute of them."""

Row = list[Value]
(TIME,) = named(["time_s"])


def batches(recording: Recording, columns: Sequence[Column], watch: Watch) -> Iterator[list[Row]]:
    """All ticks in the order of time; only the topics that the columns need are read."""
    topics = {column.topic for column in columns} | {TIME.topic}
    share = _Share(recording.duration)
    rows: list[Row] = []
    for tick in recording.ticks(topics=topics):
        rows.append([column.of(tick) for column in columns])
        if len(rows) == AT_ONCE:
            yield rows
            watch(share.at(TIME.of(tick)))
            rows = []
    if rows:
        yield rows
    watch(1.0)


class _Share:
    """How far a recording of that duration (s) is read. Its times are taken as they come, true or not."""

    def __init__(self, duration: float) -> None:
        self._duration = duration
        self._first: float | None = None

    def at(self, time: Value) -> float:
        if not isinstance(time, float) or not self._duration > 0.0:
            return 0.0
        if self._first is None:
            self._first = time
        return min(max((time - self._first) / self._duration, 0.0), 1.0)
