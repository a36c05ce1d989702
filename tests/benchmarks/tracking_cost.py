"""Tracking with heading and filter, against the usual full-frame pipeline on the same pictures in the same run.

The robot is followed through half a second of walking, again and again; the ways take turns. Times are processor time
of one thread. The figures are medians over frames; of locked tracking also the mean, against the reference's mean, with
what is done only now and then: looking at the robot closely, and at the whole picture for others like it.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from control.estimator import Estimator, EstimatorSettings
from control.field_model import FieldModel
from control.model import PIVOT_A, Body, Frame, Pose, swing
from vision.camera_model import PICTURE_HEIGHT_ON_PLATE, CameraModel
from vision.simulated.rendering import Painter, SceneSettings
from vision.tracking.tracker import ColourTracker, TrackerSettings

LENGTH, BODY_HEIGHT = 0.010, 0.003
PERIOD = 1 / 60
LATENCY = 0.035
WARM_UP = 6
"""Frames at the start of a pass in which the tracker makes sure of the robot; not counted."""
FRAMES = WARM_UP + 2 * 13
"""Counted are two rounds of what is done only now and then: at 60 Hz, every 13th picture."""
ROUNDS, PASSES = 4, 8
TILT, RATE, SWEEP = math.radians(6.9), 1.2, math.radians(25.0)
READY = 0.5
"""The field is at full strength from then on, s."""
SIZES = ((640, 480), (1280, 720), (1920, 1080))
LOCKED_TARGETS = {(640, 480): 1 / 6, (1920, 1080): 1 / 20}
REACQUIRED_TARGET = 1 / 3
SIZE_TARGET = 0.20


Times = tuple[list[float], list[float], list[float]]
"""Of a pass, one by frame, s: reference, locked tracking with filter, search for an unknown robot."""


@dataclass(frozen=True, slots=True)
class Cost:
    """Time of one frame, s: medians of the reference, of locked tracking with filter and of the search for an unknown
    robot, and the means of the first two."""

    reference: float
    locked: float
    search: float
    reference_mean: float
    locked_mean: float


class Walk:
    """A robot that follows the field, and its pictures."""

    def __init__(self, size: tuple[int, int], picture_height: float) -> None:
        self.optics = CameraModel.looking_down(size, picture_height=picture_height)
        painter = Painter(self.optics, SceneSettings())
        self.times = [READY + index * PERIOD for index in range(FRAMES)]
        field, pose, heading = started_field(), Pose(0.01, -0.02, 1.0), 1.0
        self.poses: list[Pose] = []
        for time_ in self.times:
            self.drive(field, time_)
            pose, heading = swing(pose, PIVOT_A, field.heading - heading, LENGTH), field.heading
            self.poses.append(pose)
        # The pictures' bodies lie flat, and so does the field that the estimator knows of.
        bodies = [Body(pose, PIVOT_A, 0.0) for pose in self.poses]
        self.frames = [
            Frame(painter.paint(body, index), at, index)
            for index, (body, at) in enumerate(zip(bodies, self.times, strict=True))
        ]

    def tracker(self) -> ColourTracker:
        return ColourTracker(self.optics, TrackerSettings(heading_hint=1.0), LENGTH, BODY_HEIGHT)

    @staticmethod
    def drive(field: FieldModel, until: float) -> None:
        """To and fro within the sweep."""
        if abs(field.heading - 1.0) >= SWEEP or field.is_settled:
            way = -math.copysign(1.0, field.heading - 1.0)
            field.command(PIVOT_A, TILT, way * RATE, 1.0 + way * SWEEP)
        field.advance(until)


def started_field() -> FieldModel:
    field = FieldModel(0.05, 0.03)
    field.start(0.0, 1.0, PIVOT_A, TILT, 0.001)
    field.command(PIVOT_A, TILT, RATE, 1.0 + SWEEP)
    field.advance(READY - PERIOD)
    return field


def full_frame(image: np.ndarray) -> tuple[float, float, float]:
    """Convert, threshold, contours, rectangle: the published practice."""
    hsv = cv2.cvtColor(image, cv2.COLOR_BGR2HSV)
    low = cv2.inRange(hsv, (0, 110, 60, 0), (10, 255, 255, 0))
    mask = cv2.bitwise_or(low, cv2.inRange(hsv, (170, 110, 60, 0), (179, 255, 255, 0)))
    contours, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_SIMPLE)
    (u, v), _, angle = cv2.minAreaRect(max(contours, key=cv2.contourArea))
    return u, v, math.radians(angle)


class Follower:
    """Tracker and filter on one way through the pictures."""

    def __init__(self, walk: Walk) -> None:
        self._tracker, self._field = walk.tracker(), started_field()
        self.estimator = Estimator(EstimatorSettings(lift_ratio=0.0), self._field, LENGTH)

    def drive(self, frame: Frame) -> None:
        """What the field has done by then; no part of the tracking."""
        Walk.drive(self._field, frame.captured_at)

    def look(self, frame: Frame) -> None:
        expected = self.estimator.expect(frame.captured_at)
        measurement = self._tracker.update(frame, expected).measurement
        if measurement is None:
            return
        if self.estimator.known:
            self.estimator.correct(measurement)
        else:
            self.estimator.start(measurement)


def reference_times(walk: Walk) -> list[float]:
    return [_timed(lambda each: full_frame(each.image), frame) for frame in walk.frames][WARM_UP:]


def locked_times(walk: Walk) -> list[float]:
    follower, times = Follower(walk), []
    for frame in walk.frames:
        follower.drive(frame)
        times.append(_timed(follower.look, frame))
    if follower.estimator.last_accepted != walk.times[-1]:
        raise RuntimeError("the robot was lost in the benchmark")
    return times[WARM_UP:]


def search_times(walk: Walk) -> list[float]:
    tracker, times = walk.tracker(), []
    for frame in walk.frames:
        tracker.reset()
        times.append(_timed(lambda each: tracker.update(each, None), frame))
    return times[WARM_UP:]


def costs(walks: Sequence[Walk]) -> list[Cost]:
    """The ways take turns at every pass, a few hundredths of a second, and the walks at every round, so that what else
    the machine does meets them alike. Within a pass each way runs by itself, as it does on a rig, and not in caches
    that another one has filled."""
    passes: list[list[Times]] = [[] for _ in walks]
    for _ in range(ROUNDS):
        for walk, own in zip(walks, passes, strict=True):
            own += [(reference_times(walk), locked_times(walk), search_times(walk)) for _ in range(PASSES)]
    return [_cost(each) for each in passes]


def _cost(passes: Sequence[Times]) -> Cost:
    reference, locked, search = (np.concatenate(times) for times in zip(*passes, strict=True))
    medians = (float(np.median(times)) for times in (reference, locked, search))
    return Cost(*medians, reference_mean=float(reference.mean()), locked_mean=float(locked.mean()))


def _timed(work: Callable[[Frame], object], frame: Frame) -> float:
    begin = time.thread_time()
    work(frame)
    return time.thread_time() - begin


def report() -> None:
    cv2.setNumThreads(1)
    print(
        "\ntracking with heading and filter, one OpenCV thread; the reference is the full-frame HSV pipeline"
    )
    print("the same robot in mm: it grows with the picture")
    _table([Walk(size, PICTURE_HEIGHT_ON_PLATE) for size in SIZES], LOCKED_TARGETS)
    print("the same robot in px: 37 px long in every picture")
    alike = [Walk(size, PICTURE_HEIGHT_ON_PLATE * size[1] / SIZES[0][1]) for size in SIZES]
    locked = [each.locked for each in _table(alike, {})]
    spread = max(locked) / min(locked) - 1.0
    print(
        f"locked tracking differs by {100 * spread:.0f} % between the sizes (target: {100 * SIZE_TARGET:.0f} %)"
    )


def _table(walks: Sequence[Walk], targets: Mapping[tuple[int, int], float]) -> list[Cost]:
    print(
        f"{'picture':>10} {'reference':>12} {'locked':>10} {'ratio':>7} {'target':>7} {'mean':>11} {'ratio':>7} "
        f"{'search':>11} {'ratio':>7} {'target':>7}"
    )
    measured = costs(walks)
    for walk, each in zip(walks, measured, strict=True):
        _line(walk.optics.size, each, targets.get(walk.optics.size))
    return measured


def _line(size: tuple[int, int], cost: Cost, target: float | None) -> None:
    aim = "" if target is None else f"1/{1 / target:.0f}"
    print(
        f"{size[0]:>5}x{size[1]:<4} {cost.reference * 1e3:9.3f} ms {cost.locked * 1e3:7.3f} ms "
        f"{_ratio(cost.reference, cost.locked):>7} {aim:>7} {cost.locked_mean * 1e3:8.3f} ms "
        f"{_ratio(cost.reference_mean, cost.locked_mean):>7} {cost.search * 1e3:8.3f} ms "
        f"{_ratio(cost.reference, cost.search):>7} {f'1/{1 / REACQUIRED_TARGET:.0f}':>7}"
    )


def _ratio(reference: float, taken: float) -> str:
    return f"1/{reference / taken:.1f}"
