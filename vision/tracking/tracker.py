"""Follows the robot from frame to frame: where to look, which blob it is, and its pose in the workspace."""

from __future__ import annotations

import math
from dataclasses import replace

from control.model import Expectation, Frame, Observation, Tracking
from vision.camera_model import CameraModel
from vision.tracking.attitude import FLAT, Attitude, PoseReader, remembered_side
from vision.tracking.colour import Image
from vision.tracking.detection import Blob, Window
from vision.tracking.heading import EndsMemory
from vision.tracking.identity import Owner
from vision.tracking.memory import ELSEWHERE_AFTER, Company, Looks, Memory, Steadiness
from vision.tracking.reasons import AGAIN, OTHER_SIZE, reason_for
from vision.tracking.recognition import Found, Recogniser, Robot, View
from vision.tracking.seeking import Seeker
from vision.tracking.settings import RED, TrackerSettings
from vision.tracking.windows import SIGMAS, SPARE, Place, half_extent, window_around

__all__ = ["RED", "ColourTracker", "TrackerSettings"]

FLOOR = 0.04
"""Standard deviation of a sighting about the best prediction, body lengths: ten times the measured noise, for what
the estimator's model does not know."""
HURRY = 0.25
"""Share of its way since the last sighting by which a robot may be off its prediction: a fast one needs more room."""
FARTHEST = 10.0
"""No robot is further from the coils' centre or from its place, m; what a lens' model says of places beyond all
bounds is nonsense."""
UNKNOWN_HALF = 0.6
"""Half side of a window that holds a body of unknown heading, body lengths."""
FIRST_SIGHTINGS = 3
"""A robot that was never seen, or may have been carried anywhere, counts from the third picture on that agrees."""
NEXT_SIGHTINGS = 2
"""One that was lost and is back counts from the second one on."""
WATCH_EVERY = 0.2
"""While the robot is followed, the whole picture is looked at after so long, s, for others that look like it."""


class ColourTracker:
    """Finds one robot of one colour. Satisfies the loop's tracker protocol; no clock of its own.

    robot_length: length of the body, m.  body_height: of its top surface above the plate, m.
    """

    def __init__(
        self, camera_model: CameraModel, settings: TrackerSettings, robot_length: float, body_height: float
    ) -> None:
        self._camera = camera_model
        self._height = body_height
        self._scale = camera_model.scale_at(0.0, 0.0, body_height)
        self._length = robot_length * self._scale
        self._whole: Window = (0, 0, *camera_model.size)
        self._reader = PoseReader(camera_model, robot_length, body_height, self._scale)
        self._company = Company(self._length)
        self._memory: Memory | None = None
        self.retune(settings)
        self.reset()

    def retune(self, settings: TrackerSettings) -> None:
        """Other colours or sizes from the next frame on; where the robot is stays known, its looks are forgotten."""
        self._settings = settings
        region = settings.region.scaled(self._scale**2)
        seeker = Seeker(settings.colours, region, settings.elongation_min, self._length, self._whole)
        span = 0.5 * math.sqrt(self._whole[2] * self._whole[3])
        self._recogniser = Recogniser(seeker, self._company, self._length, span)
        self._reader.heading_offset = settings.heading_offset
        if self._memory is not None:
            self._memory = replace(self._memory, looks=None)

    def reset(self) -> None:
        """Forgets the robot, and with it which end is A and who else is there."""
        self._ends = EndsMemory(self._settings.heading_hint)
        self._forget()

    def follow(self, u: float, v: float) -> None:
        """The robot is where the operator says, px; blobs elsewhere are others, whatever was expected so far."""
        self._forget()
        self._told, self._is_told = (u, v), True

    def mask(self, image: Image) -> Image:
        """255 where the picture has the robot's colour, for people to look at."""
        return self._settings.colours.mask(image)

    def update(self, frame: Frame, expected: Expectation | None) -> Observation:
        """What this frame tells: a measurement, or why there is none and for how long.

        A frame of another size than the calibration's is not looked at.
        """
        if frame.image.shape != (self._whole[3], self._whole[2], 3):
            return Observation(self._without(frame.captured_at), None, self._whole, OTHER_SIZE)
        if self._told is not None:
            self._point_out(frame, self._told)
        expected = self._heeded(expected)
        return self._seek(frame) if expected is None else self._follow(frame, expected)

    def _forget(self) -> None:
        self._company.clear()
        self._memory = None
        self._told: Place | None = None
        self._is_told = False
        self._seen_at = -math.inf
        self._was_seen = False
        self._steadiness = Steadiness(self._length)

    def _point_out(self, frame: Frame, told: Place) -> None:
        view = View(frame.image, frame.captured_at, self._whole)
        self._memory, self._told = self._recogniser.pointed_out(view, told), None

    def _heeded(self, expected: Expectation | None) -> Expectation | None:
        """None for an expectation that cannot be, and for that of a robot which the operator has said to be another."""
        if expected is None or not expected.pose.is_finite or not 0.0 <= expected.position_sigma <= FARTHEST:
            return None
        if not expected.pose.distance_to(0.0, 0.0) <= FARTHEST:
            return None
        if self._is_told and self._memory is not None:
            self._is_told = math.dist(self._place_of(expected), self._memory.place) > 0.5 * self._length
        return None if self._is_told else expected

    def _place_of(self, expected: Expectation) -> Place:
        return self._camera.to_pixel(expected.pose.x, expected.pose.y, self._height)

    def _follow(self, frame: Frame, expected: Expectation) -> Observation:
        """With an expectation: in a window, and in the whole picture only when it is not there."""
        place = self._place_of(expected)
        self._ends.heading = expected.pose.heading
        sigma, hurried = expected.position_sigma * self._scale, self._hurried(place)
        reach = SIGMAS * sigma + hurried + self._settings.margin * self._scale
        ahead = self._reader.ahead_of(expected.pose, place)
        window = self._window(place, reach, ahead, expected.heading_sigma)
        spread = math.hypot(sigma, hurried, FLOOR * self._length)
        attitude, known = Attitude.expected(expected), self._looks(frame.captured_at)
        looks = None if known is None else known.tilted(attitude.tilt)
        robot = Robot(Owner(place, spread, self._was_seen), looks)
        view = View(frame.image, frame.captured_at, window)
        found = self._recogniser.look(view, robot)
        if found.robot is None:
            found = self._recogniser.search(view, robot)
        if found.robot is None:
            return self._missed(view, found, is_anywhere=False)
        if self._company.unwatched_for(view.at) >= WATCH_EVERY:
            self._recogniser.watch(view, found)
        elif found.others:
            self._company.meet(found.others, view.at, everywhere=False)
        side = self._ends.side(remembered_side(found.robot, ahead), found.robot.end, is_followed=True)
        return self._locked(found.robot, view, side, attitude)

    def _seek(self, frame: Frame) -> Observation:
        """Without an expectation: in the whole picture, by what is remembered."""
        view = View(frame.image, frame.captured_at, self._whole)
        robot = Robot(self._remembered(view.at), self._looks(view.at))
        found, is_anywhere = self._recogniser.search(view, robot), math.isinf(robot.owner.sigma)
        if found.robot is None:
            return self._missed(view, found, is_anywhere=is_anywhere)
        if not self._steadiness.sees(found.robot.centre) >= (
            FIRST_SIGHTINGS if is_anywhere else NEXT_SIGHTINGS
        ):
            return Observation(self._without(view.at), None, view.window, AGAIN, found.others)
        self._company.meet(found.others, view.at, everywhere=True)
        ahead = self._reader.ahead(found.robot.centre, self._ends.heading)
        side = self._ends.side(remembered_side(found.robot, ahead), found.robot.end, is_followed=False)
        return self._locked(found.robot, view, side, FLAT)

    def _remembered(self, now: float) -> Owner:
        if self._memory is None:
            return Owner((0.0, 0.0), math.inf, in_view=False)
        return self._memory.owner_at(now, self._length, in_view=self._was_seen)

    def _looks(self, now: float) -> Looks | None:
        return None if self._memory is None else self._memory.looks_at(now)

    def _hurried(self, place: Place) -> float:
        """By how much a robot on its way to a place may be off it, px."""
        if self._memory is None:
            return 0.0
        return min(HURRY * math.dist(place, self._memory.place), self._length)

    def _window(self, place: Place, reach: float, ahead: Place, heading_sigma: float) -> Window:
        """Holds the whole body when its centre is within `reach` px of a place and A lies `ahead` (px) of it."""
        half_u = half_v = UNKNOWN_HALF * self._length
        if self._memory is not None and self._memory.looks is not None:
            looks = self._memory.looks
            half_u, half_v = half_extent(looks.length, looks.width, ahead, heading_sigma)
        return window_around(place, (reach + half_u + SPARE, reach + half_v + SPARE), self._whole)

    def _missed(self, view: View, found: Found, *, is_anywhere: bool) -> Observation:
        self._was_seen = False
        self._steadiness.broken()
        reason = reason_for(found, is_anywhere=is_anywhere)
        return Observation(self._without(view.at), None, view.window, reason, found.doubtful or found.others)

    def _without(self, captured_at: float) -> Tracking:
        is_recent = 0.0 <= captured_at - self._seen_at <= self._settings.predict_for
        return Tracking.PREDICTED if is_recent else Tracking.LOST

    def _locked(self, blob: Blob, view: View, side: int, attitude: Attitude) -> Observation:
        measurement = self._reader.measurement(blob, side, view.at, attitude)
        self._ends.heading = measurement.pose.heading
        known, seen = self._looks(view.at), Looks.of(blob).flat(attitude.tilt)
        self._memory = Memory(blob.centre, view.at, seen if known is None else known.learnt(seen))
        self._seen_at, self._was_seen = view.at, True
        rivals = self._company.places(view.at, ELSEWHERE_AFTER)
        return Observation(Tracking.LOCKED, measurement, view.window, "", rivals, self._ends.is_assumed)
