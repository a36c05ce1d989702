"""From recordings to what their scene is made of: the rig to scale, reference paths, and where the robots went."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from server.recording.reading.paths import paths_of
from server.recording.reading.recording import Picture, Recording
from server.replay.overview import series_of
from server.replay.shown import MM, Course, ReplaySource
from server.replay.then import camera_model_of, gait_field, rig_of
from server.scene.geometry import SceneGeometry, geometry_of
from server.scene.shapes import FULL_FIELD, full_field
from server.settings_in_si import coil_set

log = logging.getLogger(__name__)


def stage(
    recordings: Sequence[Recording], fallback: SceneGeometry, newest: Callable[[], Picture | None]
) -> ReplaySource:
    """fallback: the geometry where the first recording does not tell its rig.  newest: the picture shown last."""
    settings = recordings[0].settings
    geometry = recorded_geometry(settings) or replace(fallback, camera=camera_model_of(settings))
    field = gait_field(settings)
    scale = FULL_FIELD if field is None else full_field(field)
    return ReplaySource(geometry, [course_of(recording) for recording in recordings], newest, scale)


def recorded_geometry(settings: Mapping[str, Any]) -> SceneGeometry | None:
    rig = rig_of(settings)
    return None if rig is None else geometry_of(rig, coil_set(rig), camera_model_of(settings))


def course_of(recording: Recording) -> Course:
    series = series_of(recording)
    columns = [column(series, name) for name in ("time_s", "x_mm", "y_mm")]
    known = np.isfinite(columns).all(axis=0)
    times, x, y = (values[known] for values in columns)
    return Course(paths_of(recording), times, np.column_stack([x, y]) * MM)


def column(series: Mapping[str, Any], name: str) -> NDArray[np.float64]:
    """NaN where a value is unknown."""
    return np.array(series.get(name, []), dtype=float)
