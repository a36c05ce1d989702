"""A tracker that follows a scene's robot by its own sightings alone, and what came of each picture."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from control.arbiter import PREDICT_FOR
from control.model import Expectation, Observation, Pose, wrap
from vision.camera_model import CameraModel
from vision.simulated.scenes import SCENES, Scene, Shown, play
from vision.tracking.tracker import ColourTracker, TrackerSettings

STANDING_SIGMA = 0.0003
"""Of the position of a robot that is expected where it was seen last, m, and how that grows, m/s."""
SIGMA_GROWS = 0.010


@dataclass(frozen=True, slots=True)
class Seen:
    """One picture: the truth, and what the tracker said. optics, scene: of the picture."""

    shown: Shown
    observation: Observation
    optics: CameraModel
    height: float

    @property
    def pose(self) -> Pose | None:
        seen = self.observation.measurement
        return None if seen is None else seen.pose

    @property
    def is_plain(self) -> bool:
        """The robot is wholly in view."""
        return self.shown.body is not None and self.shown.visible >= 0.999

    @property
    def offset(self) -> float:
        """From the true centre to the measured one, m; inf without either."""
        body, pose = self.shown.body, self.pose
        if body is None or pose is None:
            return math.inf
        return pose.distance_to(body.pose.x, body.pose.y)

    @property
    def turn(self) -> float:
        """From the true heading to the measured one, rad."""
        body, pose = self.shown.body, self.pose
        if body is None or pose is None:
            return math.inf
        return abs(wrap(pose.heading - body.pose.heading))


class SceneFollower:
    """Expects the robot where it was seen last, for as long as a rig predicts, and no better."""

    def __init__(self, tracker: ColourTracker) -> None:
        self._tracker = tracker
        self._last: tuple[Pose, float] | None = None

    def look(self, shown: Shown) -> Observation:
        now = shown.frame.captured_at
        observation = self._tracker.update(shown.frame, self._expected(now, shown))
        if observation.measurement is not None:
            self._last = observation.measurement.pose, now
        return observation

    def _expected(self, now: float, shown: Shown) -> Expectation | None:
        if self._last is None or now - self._last[1] > PREDICT_FOR:
            return None
        pose, seen_at = self._last
        sigma = STANDING_SIGMA + SIGMA_GROWS * (now - seen_at)
        body = shown.body
        if body is None:
            return Expectation(pose, sigma)
        return Expectation(pose, sigma, body.pivot, body.tilt)


def tracker_of(
    scene: Scene, heading: float = 0.5 * math.pi, optics: CameraModel | None = None
) -> ColourTracker:
    settings = TrackerSettings(colour=scene.colour, end_mark=scene.end_colour, heading_hint=heading)
    return ColourTracker(optics or scene.optics, settings, scene.settings.length, scene.settings.height)


def followed(
    name: str, seed: int, frames: int = 120, *, pointed_out: bool = True, optics: CameraModel | None = None
) -> Iterator[Seen]:
    """A scene, its robot pointed out to the tracker in the first picture."""
    scene = SCENES[name]
    yield from follow(scene, play(scene, seed, frames, optics), pointed_out=pointed_out, optics=optics)


def follow(
    scene: Scene, pictures: Iterable[Shown], *, pointed_out: bool = True, optics: CameraModel | None = None
) -> Iterator[Seen]:
    optics = optics or scene.optics
    tracker: ColourTracker | None = None
    follower: SceneFollower | None = None
    for shown in pictures:
        if tracker is None or follower is None:
            heading = 0.5 * math.pi if shown.body is None else shown.body.pose.heading
            tracker = tracker_of(scene, heading, optics)
            follower = SceneFollower(tracker)
            if pointed_out and shown.body is not None:
                tracker.follow(*optics.to_pixel(shown.body.pose.x, shown.body.pose.y, scene.settings.height))
        yield Seen(shown, follower.look(shown), optics, scene.settings.height)
