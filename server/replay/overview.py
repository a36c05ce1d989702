"""The whole of a recording at a glance: its curves in a few points, its events, and what it takes to draw it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from server.recording.reading.paths import MM, paths_of
from server.recording.reading.recording import Recording
from server.replay.series import computed_series
from server.replay.then import camera_of, reference_points, robot_length_mm, workspace_half_mm

MOST_EVENTS = 1000
"""Lines of the event log that are told of; a run has about ten."""


def overview_of(recording: Recording) -> dict[str, Any]:
    """JSON; lab units in the names. Times are since the run's start."""
    settings, outcome = recording.settings, recording.outcome or {}
    camera = camera_of(settings)
    return {
        "started_at": recording.started_at.isoformat(timespec="milliseconds").replace("+00:00", "Z"),
        "duration_s": recording.duration,
        "ticks": outcome.get("ticks"),
        "frames": outcome.get("frames"),
        "is_whole": recording.is_whole,
        "frame_size_px": None if camera is None else camera["size"],
        "camera": camera,
        "workspace": {"half_mm": workspace_half_mm(settings)},
        "robot": {"length_mm": robot_length_mm(settings)},
        "reference_points_mm": reference_points(settings),
        "paths": [path_json(*path) for path in paths_of(recording)],
        "events": events_of(recording),
        "series": series_of(recording),
    }


def series_of(recording: Recording) -> Mapping[str, Any]:
    """Columns of the same length by name, time_s first."""
    overview = recording.overview
    return computed_series(recording) if overview is None else overview.get("series", overview)


def events_of(recording: Recording) -> list[dict[str, Any]]:
    """What was told a moment before the first tick belongs to the beginning."""
    lines = recording.events(MOST_EVENTS)
    return [{**line, "time_s": max(line["time_s"], 0.0)} for line in lines]


def path_json(time: float, points: NDArray[np.float64]) -> dict[str, Any]:
    """points: (n, 2), m, of the path that was to be walked from that time on."""
    return {"time_s": time, "points_mm": (points / MM).tolist()}
