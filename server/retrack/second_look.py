"""The rig's own tracker and filter, run over recorded pictures and the recorded field."""

from __future__ import annotations

import math

from control.model import Frame, Measurement, Pose, Tracking
from control.perception import Perception
from control.recorded_field import RecordedField
from server.calibration.optics import model_in_use
from server.retrack.recorded_tick import RecordedTick
from server.settings import MM, MS, RigFile
from server.settings_in_si import estimator_settings, field_slew
from server.vision_settings import tracker_settings
from vision.tracking.tracker import ColourTracker


class SecondLook:
    """Give it each tick in turn. It begins where the rig knew the robot to be, and which way round.

    is_looking: a picture has been searched.  sighted: the newest one showed the robot, and believed: the filter
    took that in.
    """

    def __init__(self, rig: RigFile) -> None:
        robot = rig.robot
        self.field = RecordedField(rig.link.ramp_ms * MS, field_slew(rig))
        tracker = ColourTracker(
            model_in_use(rig.camera),
            tracker_settings(rig.vision),
            robot_length=robot.body_length_mm * MM,
            body_height=robot.body_height_mm * MM,
        )
        backlash = math.radians(rig.estimator.backlash_deg)
        self.perception = Perception(
            tracker, self.field, estimator_settings(rig), robot.length_mm * MM, backlash
        )
        self.pose: Pose | None = None
        self.is_looking = False
        self._has_begun = False

    @property
    def tracking(self) -> Tracking:
        return self.perception.tracking

    @property
    def sighted(self) -> bool:
        seen = self.perception.observation
        return seen is not None and seen.measurement is not None

    @property
    def believed(self) -> bool:
        return self.sighted and self.tracking is Tracking.LOCKED

    def tick(self, tick: RecordedTick, frame: Frame | None) -> None:
        """The field moves on, a picture that came at this tick is searched, and the estimate is carried on."""
        self.field.follow(tick.time, tick.trace)
        if not self._has_begun and tick.pose is not None and tick.captured_at is not None:
            self._begin(tick.pose, tick.captured_at)
        if frame is not None:
            self.perception.look(frame)
            self.is_looking = True
        self.pose, _ = self.perception.pose_at(tick.time)

    def _begin(self, pose: Pose, captured_at: float) -> None:
        """A run begins with a robot at rest, so what is known of it now was true a moment before the picture too.

        Not of the picture's own time: that would count as a sighting in it.
        """
        self._has_begun = True
        before = math.nextafter(captured_at, -math.inf)
        self.perception.estimator.start(Measurement(pose, before, (0.0, 0.0), (), 0.0))
