"""The path that was to be walked, as a recording has it: another one may be chosen while the robot walks."""

from __future__ import annotations

import itertools
from bisect import bisect_right
from collections.abc import Sequence
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from server.recording.reading.recording import Recording
from server.recording.topics import SELECTION

MM = 1e-3
MOST = 100
"""Paths that are told of; seldom is more than one walked in a run."""

Path = tuple[float, NDArray[np.float64]]
"""From when it holds, s since the run's start, and its points (n, 2), m."""


class _Selection(msgspec.Struct):
    """The part of a selection message that is a path."""

    reference_x_mm: list[float]
    reference_y_mm: list[float]


class _Settings(msgspec.Struct):
    """The part of a recording's settings that is a path: the one that the run began with."""

    reference_points_mm: list[tuple[float, float]] = []


def paths_of(recording: Recording) -> list[Path]:
    """In the order of time, the first from the beginning; without points where they are lost."""
    paths = [(0.0, _begun_with(recording.settings))]
    for entry in itertools.islice(recording.messages([SELECTION.name]), MOST):
        points = _chosen(entry.data)
        if points is not None and not np.array_equal(points, paths[-1][1]):
            paths.append((entry.time_s, points))
    return paths


def path_at(paths: Sequence[Path], time: float) -> NDArray[np.float64]:
    """(n, 2) the points of the one that holds at that time, s since the run's start; m."""
    index = bisect_right(paths, time, key=lambda path: path[0])
    return paths[max(index - 1, 0)][1]


def _begun_with(settings: Any) -> NDArray[np.float64]:
    try:
        return _points(msgspec.convert(settings, _Settings).reference_points_mm)
    except msgspec.ValidationError:
        return _points(())


def _chosen(message: Any) -> NDArray[np.float64] | None:
    try:
        chosen = msgspec.convert(message, _Selection)
    except msgspec.ValidationError:
        return None
    return _points(tuple(zip(chosen.reference_x_mm, chosen.reference_y_mm, strict=False)))


def _points(mm: Sequence[tuple[float, float]]) -> NDArray[np.float64]:
    return np.array(mm, float).reshape(-1, 2) * MM
