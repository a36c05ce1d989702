"""Waypoints from the text of a file: CSV with a point a line, or a JSON list of points."""

from __future__ import annotations

import json
import math
from typing import Any

LARGEST = 10_000_000
"""Longest text that is read, characters: a thousand for each of the points that a path may have."""
ALLOWED = "allowed: two numbers in mm a line, x and y, such as 10.0, -20.0"


class WaypointFileError(ValueError):
    """A text that holds no waypoints."""


def read_points(text: str) -> list[tuple[float, float]]:
    """The points, mm; raises `WaypointFileError` with the line or the number of the point that is wrong.

    CSV: x_mm, y_mm and any further columns, which are ignored; separated by commas, semicolons, tabs or spaces;
    one header line, empty lines and lines that begin with # are skipped. JSON: [[x, y], ...].
    """
    if len(text) > LARGEST:
        raise WaypointFileError(f"the file has {len(text)} characters; at most {LARGEST} are read")
    text = text.removeprefix("\ufeff")
    points = _from_json(text) if text.lstrip().startswith("[") else _from_csv(text)
    if not points:
        raise WaypointFileError(f"the file has no points; {ALLOWED}")
    return points


def _from_csv(text: str) -> list[tuple[float, float]]:
    points: list[tuple[float, float]] = []
    lines = [(number, line.strip()) for number, line in enumerate(text.splitlines(), start=1)]
    lines = [(number, line) for number, line in lines if line and not line.startswith("#")]
    for place, (number, line) in enumerate(lines):
        point = _point(_columns(line)[:2])
        if point is not None:
            points.append(point)
        elif place > 0 or not _is_header(line):
            raise WaypointFileError(f"line {number} is {line[:60]!r}; {ALLOWED}")
    return points


def _columns(line: str) -> list[str]:
    for separator in (",", ";", "\t"):
        if separator in line:
            return [column.strip() for column in line.split(separator)]
    return line.split()


def _is_header(line: str) -> bool:
    """Names rather than numbers."""
    return all(_number(column) is None for column in _columns(line)[:2])


def _from_json(text: str) -> list[tuple[float, float]]:
    try:
        entries = json.loads(text)
    except (json.JSONDecodeError, RecursionError) as error:
        where = f"line {error.lineno}: {error.msg}" if isinstance(error, json.JSONDecodeError) else "too deep"
        raise WaypointFileError(f"the JSON cannot be read, {where}; allowed: [[x, y], …] in mm") from None
    points = []
    for number, entry in enumerate(entries, start=1):
        point = _point(entry) if isinstance(entry, list) and len(entry) == 2 else None
        if point is None:
            raise WaypointFileError(
                f"point {number} is {str(entry)[:60]}; allowed: [x, y], two numbers in mm"
            )
        points.append(point)
    return points


def _point(columns: list[Any]) -> tuple[float, float] | None:
    numbers = [_number(column) for column in columns]
    if len(numbers) != 2 or numbers[0] is None or numbers[1] is None:
        return None
    return numbers[0], numbers[1]


def _number(column: Any) -> float | None:
    if isinstance(column, bool) or not isinstance(column, str | int | float):
        return None
    try:
        number = float(column)
    except (ValueError, OverflowError):
        return None
    return number if math.isfinite(number) else None
