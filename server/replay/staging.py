"""From recordings to what their scene is made of: the rig to scale, reference paths, and where the robots went."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from server.recording.reading.paths import paths_of
from server.recording.reading.recording import Recording
from server.replay.overview import series_of
from server.replay.shown import MM, Course, ReplaySource
from server.replay.then import rig_of
from server.scene.geometry import SceneGeometry, geometry_of
from server.settings_in_si import coil_set

log = logging.getLogger(__name__)


def stage(recordings: Sequence[Recording], fallback: SceneGeometry) -> ReplaySource:
    """fallback: the geometry where the first recording does not tell its rig."""
    geometry = recorded_geometry(recordings[0].settings) or fallback
    return ReplaySource(geometry, [course_of(recording) for recording in recordings])


def recorded_geometry(settings: Mapping[str, Any]) -> SceneGeometry | None:
    rig = rig_of(settings)
    return None if rig is None else geometry_of(rig, coil_set(rig))


def course_of(recording: Recording) -> Course:
    series = series_of(recording)
    columns = [column(series, name) for name in ("time_s", "x_mm", "y_mm")]
    known = np.isfinite(columns).all(axis=0)
    times, x, y = (values[known] for values in columns)
    return Course(paths_of(recording), times, np.column_stack([x, y]) * MM)


def column(series: Mapping[str, Any], name: str) -> NDArray[np.float64]:
    """NaN where a value is unknown."""
    return np.array(series.get(name, []), dtype=float)
