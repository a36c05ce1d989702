"""The curves of a part of a recording, or of one that has no overview yet: it is torn, or still being written."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from server.recording.reading.recording import Recording
from server.recording.reading.tick_reading import Tick
from server.recording.recovery.recount import NOTHING, point_of_messages

MOST_POINTS = 600
"""Instants that are looked up: about half a second's work, however long the recording is."""


def computed_series(
    recording: Recording, start: float = 0.0, end: float = math.inf
) -> dict[str, list[float | None]]:
    """The same columns that the overview of a finished recording has, from `start` to `end`, s since its start."""
    columns: dict[str, list[float | None]] = {}
    for time, tick in sampled(recording, start, min(end, recording.duration)):
        for name, value in {"time_s": time, **point_of_messages(tick)}.items():
            columns.setdefault(name, []).append(value)
    return columns


def sampled(recording: Recording, start: float, end: float) -> Iterator[tuple[float, Tick]]:
    """Different ticks, evenly spread, with the time at which each is the newest, s since the run's start."""
    last = None
    for time in np.linspace(start, end, MOST_POINTS) if start < end else ():
        tick = recording.tick_at(float(time))
        number = None if tick is None else tick.get("/state", NOTHING).get("tick")
        if tick is not None and number != last:
            last = number
            yield float(time), tick
