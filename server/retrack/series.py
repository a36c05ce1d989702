"""The second look as columns: a few points for the page, every tick for a table."""

from __future__ import annotations

import csv
import math
from typing import Any, TextIO

from control.model import Pose
from server.retrack.comparison import Seen
from server.settings import MM

MOST_POINTS = 2000
Row = dict[str, float | int | str | None]


def row(seen: Seen) -> Row:
    """Lab units in the names; None for what is not known."""
    tick, answer = seen.tick, seen.answer
    told = None if answer is None else answer.now
    return {
        "time_s": tick.since_start,
        "tick": tick.number,
        **_pose(seen.pose, ""),
        "tracking": seen.tracking.value,
        "is_picture": int(seen.looked),
        "error_mm": _scaled(seen.error, 1.0 / MM),
        "distance_mm": _scaled(seen.distance, 1.0 / MM),
        "turn_deg": _scaled(seen.turn, 180.0 / math.pi),
        **_pose(tick.pose, "then_"),
        "then_tracking": tick.tracking,
        "then_error_mm": _scaled(seen.error_then, 1.0 / MM),
        "pivot": None if told is None else told.pivot,
        "rate_deg_s": None if told is None else math.degrees(told.rate),
        "then_pivot": tick.command.pivot,
        "then_rate_deg_s": math.degrees(tick.command.rate),
    }


def _pose(pose: Pose | None, prefix: str) -> Row:
    return {
        f"{prefix}x_mm": None if pose is None else pose.x / MM,
        f"{prefix}y_mm": None if pose is None else pose.y / MM,
        f"{prefix}heading_deg": None if pose is None else math.degrees(pose.heading),
    }


def _scaled(value: float | None, factor: float) -> float | None:
    return None if value is None else value * factor


class Thinned:
    """At most `MOST_POINTS` rows, evenly spread, of any number that comes: memory stays bounded."""

    def __init__(self) -> None:
        self._rows: list[Row] = []
        self._stride = 1
        self._count = 0

    def add(self, seen: Seen) -> None:
        if self._count % self._stride == 0:
            if len(self._rows) == MOST_POINTS:
                self._rows, self._stride = self._rows[::2], 2 * self._stride
            if self._count % self._stride == 0:
                self._rows.append(row(seen))
        self._count += 1

    def columns(self) -> dict[str, list[Any]]:
        """By name, of the same length."""
        return {name: [each[name] for each in self._rows] for name in (self._rows[0] if self._rows else ())}


class CsvTable:
    """One line a tick, every digit, nothing where something is unknown."""

    def __init__(self, file: TextIO) -> None:
        self._file = file
        self._writer: csv.DictWriter[str] | None = None

    def add(self, seen: Seen) -> None:
        line = row(seen)
        if self._writer is None:
            self._writer = csv.DictWriter(self._file, list(line), lineterminator="\n")
            self._writer.writeheader()
        self._writer.writerow({name: "" if value is None else value for name, value in line.items()})
