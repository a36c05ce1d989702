"""From frames to the pose now: tracker, filter and backlash joined, with the age of what is known."""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from control.acceptance import without_nonsense
from control.arbiter import PREDICT_FOR
from control.backlash import Backlash
from control.estimator import Estimator, EstimatorSettings
from control.field import Field
from control.model import Expectation, Frame, Measurement, Observation, Pose, Tracking, wrap
from control.snapshot import ZERO, Covariance, Vector

LOST_WITHIN = 3.0
"""A robot that may be more than its own length away, at so many standard deviations, is lost (faults.md)."""
MOST_DOUBT = 10.0
"""So many sightings in a row that are not where the robot should be, and it is lost: 0.17 s at 60 Hz."""
REGAINED = 0.5
"""What a sighting that is where it should be takes from the doubt: every other one wrong is too many for long."""
THUMBNAIL = 16
"""Every 16th pixel of every 16th row tells a new picture: sensor noise never repeats."""
NO_COVARIANCE: Covariance = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
NOT_BELIEVED = "something like the robot is seen, but not where the robot can be"


class Tracker(Protocol):
    """Finds the robot in a frame; see `vision.tracking.tracker`."""

    def update(self, frame: Frame, expected: Expectation | None) -> Observation: ...

    def reset(self) -> None: ...


class Perception:
    """What the rig knows of the robot; `look` at each frame, `pose_at` for the estimate."""

    def __init__(
        self, tracker: Tracker, field: Field, settings: EstimatorSettings, length: float, backlash: float
    ) -> None:
        """length: distance between the pivots, m.  backlash: first guess of the whole play, rad."""
        self._tracker = tracker
        self._field = field
        self._length = length
        self._doubt = 0.0
        self._delay = settings.actuation_delay
        self.estimator = Estimator(settings, field, length)
        self.backlash = Backlash(0.5 * backlash)
        self.observation: Observation | None = None
        self.frame: Frame | None = None
        self.identical_frames = 0
        self.refused_sightings = 0
        """Sightings that were no finite numbers."""
        self.tracking = Tracking.LOST
        self.covariance = NO_COVARIANCE
        """Of the pose that `pose_at` has told last; zero for none."""
        self._thumbnail = b""
        self._picture: NDArray[np.uint8] = np.empty(0, np.uint8)

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

    def forget(self) -> None:
        """Know nothing of the robot, not even which end is which: the next sighting is the first one."""
        self._tracker.reset()
        self.estimator.forget()
        self.tracking = Tracking.LOST

    @property
    def age(self) -> float:
        """From the newest accepted sighting to the newest frame, s; inf while the robot is not known."""
        if self.frame is None or not self.estimator.known:
            return math.inf
        return self.frame.captured_at - self.estimator.last_accepted

    def pose_at(self, now: float) -> tuple[Pose | None, Vector]:
        """The estimate carried forward to now and its standard deviations (m, m, rad)."""
        if not self.estimator.known:
            self.covariance = NO_COVARIANCE
            return None, ZERO
        carried = self.estimator.carry(now)
        self.covariance = carried.covariance
        return carried.pose, carried.sigma

    @property
    def reason(self) -> str:
        """Why there is no lock, in the operator's words; "" with one."""
        if self.tracking is Tracking.LOCKED or self.observation is None:
            return ""
        return self.observation.reason or NOT_BELIEVED

    @property
    def assumes_ends(self) -> bool:
        """Nothing has told yet which end of the robot is A, but the rig file."""
        return self.observation is not None and self.observation.assumes_ends

    def _repeats(self, frame: Frame) -> bool:
        """Few cameras come to the second look: one that cleans its pictures of noise may show a plate that is the
        same in every sample, while a robot smaller than their distance has moved between them."""
        thumbnail = frame.image[::THUMBNAIL, ::THUMBNAIL].tobytes()
        is_same = thumbnail == self._thumbnail and np.array_equal(frame.image, self._picture)
        self.identical_frames = self.identical_frames + 1 if is_same else 1
        self._thumbnail, self._picture = thumbnail, frame.image
        return is_same

    def _expect(self, frame: Frame) -> Expectation | None:
        self.estimator.half_play = self.backlash.half_width
        return self.estimator.expect(frame.captured_at)

    def _take(self, measurement: Measurement) -> None:
        if not self.estimator.known:
            self.estimator.start(measurement)
            self._doubt = 0.0
        elif self.estimator.correct(measurement):
            self._doubt = max(self._doubt - REGAINED, 0.0)
            self._observe_backlash(measurement)
        else:
            self._doubt += 1.0

    def _judge(self, frame: Frame) -> None:
        since = frame.captured_at - self.estimator.last_accepted
        if self.estimator.known and not self._may_predict(since):
            self.estimator.forget()
        if not self.estimator.known:
            self.tracking = Tracking.LOST
        else:
            self.tracking = Tracking.LOCKED if since == 0.0 else Tracking.PREDICTED

    def _may_predict(self, since: float) -> bool:
        """Whether the prediction still tells where the robot is. since: the last accepted sighting, s."""
        is_near = LOST_WITHIN * self.estimator.position_sigma <= self._length
        return since <= PREDICT_FOR and self._doubt < MOST_DOUBT and is_near

    def _observe_backlash(self, measurement: Measurement) -> None:
        """A sighting while the field surely pulls the body one way tells how far it leads."""
        grip = self.estimator.grip
        if grip.is_tight:
            field = self._field.heading_at(measurement.captured_at - self._delay)
            self.backlash.observe(1 if grip.pull > 0.0 else -1, wrap(field - measurement.pose.heading))
