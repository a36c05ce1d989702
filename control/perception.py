"""From frames to the pose now: tracker, filter and backlash joined, with the age of what is known."""

from __future__ import annotations

import math
from typing import Protocol

from control.acceptance import without_nonsense
from control.arbiter import PREDICT_FOR
from control.backlash import Backlash
from control.estimator import Estimator, EstimatorSettings
from control.field_model import FieldModel
from control.model import Expectation, Frame, Measurement, Observation, Pose, Tracking, wrap
from control.snapshot import ZERO, Vector

THUMBNAIL = 16
"""Every 16th pixel of every 16th row tells a repeated picture: sensor noise never repeats."""


class Tracker(Protocol):
    """Finds the robot in a frame; see `vision.tracking.tracker`."""

    def update(self, frame: Frame, expected: Expectation | None) -> Observation: ...

    def reset(self) -> None: ...


class Perception:
    """What the rig knows of the robot; `look` at each frame, `pose_at` for the estimate."""

    def __init__(
        self, tracker: Tracker, field: FieldModel, settings: EstimatorSettings, length: float, backlash: float
    ) -> None:
        """length: distance between the pivots, m.  backlash: first guess of the whole play, rad."""
        self._tracker = tracker
        self._field = field
        self._delay = settings.actuation_delay
        self.estimator = Estimator(settings, field, length)
        self.backlash = Backlash(0.5 * backlash)
        self.observation: Observation | None = None
        self.frame: Frame | None = None
        self.identical_frames = 0
        self.refused_sightings = 0
        """Sightings that were no finite numbers."""
        self.tracking = Tracking.LOST
        self._thumbnail = b""

    def look(self, frame: Frame) -> None:
        """Search one frame and correct the estimate; a repeated or an older picture is not looked at.

        A robot that stays away from its prediction is lost for at least this one frame, so that a rig that
        drives it comes to a hold before it may be found somewhere else.
        """
        is_newer = self.frame is None or frame.captured_at > self.frame.captured_at
        if self._repeats(frame) or not is_newer:
            return
        self.frame = frame
        seen = self._tracker.update(frame, self._expect(frame))
        self.observation = without_nonsense(seen)
        self.refused_sightings += self.observation is not seen
        if self.observation.measurement is not None:
            self._take(self.observation.measurement)
        self._judge(frame)

    @property
    def age(self) -> float:
        """From the newest accepted sighting to the newest frame, s; inf while the robot is not known."""
        if self.frame is None or not self.estimator.known:
            return math.inf
        return self.frame.captured_at - self.estimator.last_accepted

    def pose_at(self, now: float) -> tuple[Pose | None, Vector]:
        """The estimate carried forward to now and its standard deviations (m, m, rad)."""
        if not self.estimator.known:
            return None, ZERO
        carried = self.estimator.carry(now)
        return carried.pose, carried.sigma

    def _repeats(self, frame: Frame) -> bool:
        thumbnail = frame.image[::THUMBNAIL, ::THUMBNAIL].tobytes()
        self.identical_frames = self.identical_frames + 1 if thumbnail == self._thumbnail else 1
        self._thumbnail = thumbnail
        return self.identical_frames > 1

    def _expect(self, frame: Frame) -> Expectation | None:
        self.estimator.half_play = self.backlash.half_width
        return self.estimator.expect(frame.captured_at)

    def _take(self, measurement: Measurement) -> None:
        if not self.estimator.known:
            self.estimator.start(measurement)
        elif self.estimator.correct(measurement):
            self._observe_backlash(measurement)

    def _judge(self, frame: Frame) -> None:
        since = frame.captured_at - self.estimator.last_accepted
        if self.estimator.known and since > PREDICT_FOR:
            self.estimator.forget()
        if not self.estimator.known:
            self.tracking = Tracking.LOST
        else:
            self.tracking = Tracking.LOCKED if since == 0.0 else Tracking.PREDICTED

    def _observe_backlash(self, measurement: Measurement) -> None:
        """A sighting while the field surely pulls the body one way tells how far it leads."""
        grip = self.estimator.grip
        if grip.is_tight:
            field = self._field.heading_at(measurement.captured_at - self._delay)
            self.backlash.observe(1 if grip.pull > 0.0 else -1, wrap(field - measurement.pose.heading))
