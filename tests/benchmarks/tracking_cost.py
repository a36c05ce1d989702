"""Locked tracking with heading and filter update, against the usual full-frame pipeline in the same run."""

from __future__ import annotations

import math
import time
from collections.abc import Callable

import cv2
import numpy as np

from control.estimator import Estimator, EstimatorSettings
from control.field_model import FieldModel
from control.model import Body, Frame, Pose
from control.simulation.plant import build_plant
from vision.camera_model import CameraModel
from vision.simulated.rendering import Painter, SceneSettings
from vision.tracking.tracker import ColourTracker, TrackerSettings

REPEATS = 400


def report() -> None:
    print("\ntracking at 640x480, one OpenCV thread, median of", REPEATS)
    optics = CameraModel.looking_down()
    painter = Painter(optics, SceneSettings())
    pose = Pose(0.01, -0.02, 1.0)
    body = Body(pose, build_plant("noslip", 0.010, pose).pivot, 0.0)
    frames = [Frame(painter.paint(body, index), index / 60, index) for index in range(16)]
    reference = _median(lambda index: _full_frame(frames[index % 16].image))
    locked = _median(_locked(optics, frames))
    print(f"full-frame HSV pipeline (reference)  {reference * 1e3:6.3f} ms")
    print(f"locked tracking with filter update   {locked * 1e3:6.3f} ms")
    print(f"ratio                                {locked / reference:6.3f}  (1/{reference / locked:.1f})")


def _full_frame(image: np.ndarray) -> tuple[float, float, float]:
    """Convert, threshold, contours, rectangle: the published practice."""
    hsv = cv2.cvtColor(image, cv2.COLOR_BGR2HSV)
    low = cv2.inRange(hsv, (0, 110, 60, 0), (10, 255, 255, 0))
    mask = cv2.bitwise_or(low, cv2.inRange(hsv, (170, 110, 60, 0), (179, 255, 255, 0)))
    contours, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_SIMPLE)
    (u, v), _, angle = cv2.minAreaRect(max(contours, key=cv2.contourArea))
    return u, v, math.radians(angle)


def _locked(optics: CameraModel, frames: list[Frame]) -> Callable[[int], None]:
    tracker = ColourTracker(optics, TrackerSettings(heading_hint=1.0), robot_length=0.010, body_height=0.003)
    estimator = Estimator(EstimatorSettings(), FieldModel(0.05, 0.03), 0.010)
    first = tracker.update(frames[0], None).measurement
    assert first is not None
    estimator.start(first)

    def once(index: int) -> None:
        frame = Frame(frames[index % 16].image, (index + 1) / 60, index + 1)
        measurement = tracker.update(frame, estimator.expect(frame.captured_at)).measurement
        assert measurement is not None
        estimator.correct(measurement)

    return once


def _median(work: Callable[[int], object]) -> float:
    times = []
    for index in range(REPEATS):
        begin = time.perf_counter()
        work(index)
        times.append(time.perf_counter() - begin)
    return float(np.median(times))
