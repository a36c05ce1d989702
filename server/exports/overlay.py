"""What the rig knew when a picture was taken, drawn over that picture."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from control.model import PIVOT_A, PIVOT_B, Measurement, Observation, Pose, Tracking
from server.exports.formats import ExportError
from server.recording.clock import rig_time_of_start
from server.recording.reading.paths import path_at, paths_of
from server.recording.reading.recording import Recording
from server.recording.reading.tick_reading import Tick
from server.trail import EVERY, POINTS
from vision.camera_model import CalibrationError, CameraModel, Row
from vision.overlay import Drawing, draw_overlay
from vision.tracking.colour import Image

MM = 1e-3
TOPICS = ("/state", "/estimate", "/measurement", "/reference", "/command")
REMEMBERED = 120
"""Ticks in which the pose at a capture is looked for: two seconds, far more than a camera is late."""
SAME = 1e-6
"""Two times of the same capture differ by their rounding to nanoseconds only, s."""


class _Camera(msgspec.Struct):
    size_px: tuple[int, int]
    fx_px: float
    fy_px: float
    cx_px: float
    cy_px: float
    distortion: tuple[float, float, float, float, float]
    rotation: tuple[Row, Row, Row]
    translation_mm: Row

    def model(self) -> CameraModel:
        x, y, z = self.translation_mm
        pinhole = self.fx_px, self.fy_px, self.cx_px, self.cy_px
        return CameraModel(self.size_px, *pinhole, self.distortion, self.rotation, (x * MM, y * MM, z * MM))


class _Robot(msgspec.Struct):
    length_mm: float


class _Rig(msgspec.Struct):
    robot: _Robot


class _Settings(msgspec.Struct):
    """The part of a recording's settings that is needed to draw."""

    camera: _Camera
    rig: _Rig
    body_height_mm: float


class Overlay:
    """Pictures are to be given in the order of their times; the ticks are read beside them."""

    def __init__(self, recording: Recording) -> None:
        """Raises `ExportError` when the recording does not say how its camera looked."""
        try:
            self._settings = msgspec.convert(recording.settings, _Settings)
            self._model = self._settings.camera.model()
        except (msgspec.ValidationError, CalibrationError) as error:
            raise ExportError(
                f"nothing can be drawn over the pictures, since the recording's settings are damaged ({error}); "
                "take the film without the overlay"
            ) from error
        self._paths = paths_of(recording)
        self._begin = rig_time_of_start(recording)
        self._ticks = recording.ticks(topics=TOPICS)
        self._tick: Tick = {}
        self._poses: deque[tuple[float, float, float, float]] = deque(maxlen=REMEMBERED)
        self._trail: deque[tuple[float, float]] = deque(maxlen=POINTS)

    @classmethod
    @contextmanager
    def of(cls, path: Path) -> Iterator[Overlay]:
        """With the file opened once more, since pictures and ticks are read at different places."""
        with Recording.open(path) as recording:
            yield cls(recording)

    def drawn(self, image: Image, captured: float) -> Image:
        """captured: when the picture was taken, s since the run's start."""
        time = self._begin + captured
        self._advance(time)
        command = self._tick.get("/command", {})
        drawing = Drawing(
            length=self._settings.rig.robot.length_mm * MM,
            body_height=self._settings.body_height_mm * MM,
            pose=self._pose_at(time),
            pivot=PIVOT_B if command.get("pivot") == PIVOT_B else PIVOT_A,
            observation=_observation(self._tick),
            reference=path_at(self._paths, captured),
            trail=np.array(self._trail, float).reshape(-1, 2),
            target=_point(self._tick.get("/reference")),
        )
        return np.asarray(draw_overlay(image, self._model, drawing), np.uint8)

    def _advance(self, time: float) -> None:
        """On to the tick in which the picture of that time (rig time, s) was searched."""
        while not (self._tick and _number(self._tick, "/state", "captured_s", -np.inf) >= time - SAME):
            tick = next(self._ticks, None)
            if tick is None:
                return
            self._tick = tick
            self._note(tick)

    def _note(self, tick: Tick) -> None:
        point = _point(tick.get("/estimate"))
        if point is None:
            return
        heading = np.radians(_number(tick, "/estimate", "heading_deg", 0.0))
        self._poses.append((_number(tick, "/estimate", "time_s", 0.0), *point, float(heading)))
        if _number(tick, "/estimate", "tick", 0) % EVERY == 0:
            self._trail.append(point)

    def _pose_at(self, time: float) -> Pose | None:
        """The estimate at that time, between its ticks; None before the first, or while there is none."""
        if not self._poses or "/estimate" not in self._tick:
            return None
        times, x, y, heading = np.array(self._poses).T
        return Pose(*(float(np.interp(time, times, each)) for each in (x, y, heading)))


def _number(tick: Tick, topic: str, name: str, otherwise: float) -> float:
    value = tick.get(topic, {}).get(name)
    return value if isinstance(value, int | float) else otherwise


def _point(message: Any) -> tuple[float, float] | None:
    """x and y of a message, m."""
    if not isinstance(message, dict):
        return None
    x, y = message.get("x_mm"), message.get("y_mm")
    return (x * MM, y * MM) if isinstance(x, int | float) and isinstance(y, int | float) else None


class _Sighting(msgspec.Struct):
    """The part of a measurement message that is drawn."""

    window_px: tuple[int, int, int, int]
    corners_px: tuple[float, ...] = ()


def _observation(tick: Tick) -> Observation | None:
    try:
        seen = msgspec.convert(tick.get("/measurement", {}), _Sighting)
        tracking = Tracking(tick.get("/state", {}).get("tracking", Tracking.LOST))
    except (msgspec.ValidationError, ValueError):
        return None
    return Observation(tracking, _outline(seen.corners_px), seen.window_px)


def _outline(corners: tuple[float, ...]) -> Measurement | None:
    """A sighting as far as it is drawn: its rectangle."""
    points: NDArray[np.float64] = np.array(corners, float)
    if points.size < 6 or points.size % 2:
        return None
    outline = tuple((float(u), float(v)) for u, v in points.reshape(-1, 2))
    return Measurement(Pose(0.0, 0.0, 0.0), 0.0, outline[0], outline, 0.0)
