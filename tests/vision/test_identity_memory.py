"""What the tracker remembers of the robot and of the others, while it is hidden and after it."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scripted_scene import HEIGHT, LENGTH, OPTICS, SCENE

from control.model import PIVOT_A, Body, Expectation, Frame, Observation, Pose, Tracking, wrap
from vision.simulated.rendering import Painter
from vision.tracking.memory import ELSEWHERE_AFTER
from vision.tracking.reasons import COVERED, OTHERS
from vision.tracking.tracker import ColourTracker, TrackerSettings

RATE = 60
PAINTER = Painter(OPTICS, SCENE)
ROBOT = Body(Pose(0.0, 0.0, 0.4), PIVOT_A, 0.0)
TWIN = Body(Pose(0.018, 0.004, -0.5), PIVOT_A, 0.0)
HALF = 26
"""Half side of the patch that holds a robot, px."""


def place_of(body: Body) -> tuple[float, float]:
    return OPTICS.to_pixel(body.pose.x, body.pose.y, HEIGHT)


def picture(bodies: list[Body], index: int) -> NDArray[np.uint8]:
    """All of them, each in a patch of its own."""
    image = PAINTER.paint(None, index).copy()
    for body in bodies:
        painted = PAINTER.paint(body, index)
        u, v = (round(place) for place in place_of(body))
        patch = slice(v - HALF, v + HALF), slice(u - HALF, u + HALF)
        image[patch] = painted[patch]
    return image


class Watching:
    """A tracker that is shown one picture after the other, with no expectation."""

    def __init__(self, **settings) -> None:
        self.tracker = ColourTracker(OPTICS, TrackerSettings(**settings), LENGTH, HEIGHT)
        self._index = 0

    def sees(self, *bodies: Body, count: int = 1, expected: Expectation | None = None) -> Observation:
        observation = None
        for _ in range(count):
            frame = Frame(picture(list(bodies), self._index), self._index / RATE, self._index)
            observation = self.tracker.update(frame, expected)
            self._index += 1
        assert observation is not None
        return observation

    def sees_for(self, duration: float, *bodies: Body) -> Observation:
        return self.sees(*bodies, count=round(duration * RATE))


def is_at(observation: Observation, body: Body) -> bool:
    seen = observation.measurement
    return seen is not None and seen.pose.distance_to(body.pose.x, body.pose.y) < 2e-4


def test_of_two_alike_none_is_taken_until_the_operator_points_to_one():
    watching = Watching()
    unsure = watching.sees(ROBOT, TWIN, count=20)
    assert unsure.tracking is Tracking.LOST
    assert unsure.reason == "2 blobs look like the robot: click the right one"
    assert len(unsure.rivals) == 2
    assert all(min(math.dist(place_of(one), rival) for rival in unsure.rivals) < 4.0 for one in (ROBOT, TWIN))
    watching.tracker.follow(*place_of(TWIN))
    assert is_at(watching.sees(ROBOT, TWIN, count=3), TWIN)
    watching.tracker.follow(*place_of(ROBOT))
    followed = watching.sees(ROBOT, TWIN, count=3)
    assert is_at(followed, ROBOT)
    assert followed.reason == ""
    assert len(followed.rivals) == 1
    assert math.dist(followed.rivals[0], place_of(TWIN)) < 4.0


def test_a_click_counts_although_another_robot_is_expected():
    watching = Watching()
    watching.sees(ROBOT, count=3)
    expected = Expectation(ROBOT.pose, 1e-4)
    assert is_at(watching.sees(ROBOT, TWIN, count=20, expected=expected), ROBOT)
    watching.tracker.follow(*place_of(TWIN))
    assert is_at(watching.sees(ROBOT, TWIN, count=3, expected=expected), TWIN)
    assert is_at(watching.sees(ROBOT, TWIN, expected=Expectation(TWIN.pose, 1e-4)), TWIN)


def test_while_the_robot_is_away_the_other_one_is_never_taken_for_it():
    watching = Watching()
    watching.sees(ROBOT, count=3)
    watching.sees(ROBOT, TWIN, count=20)
    alone = watching.sees_for(3.0, TWIN)
    assert alone.measurement is None
    assert alone.reason == OTHERS
    assert is_at(watching.sees(ROBOT, TWIN, count=3), ROBOT)


@pytest.mark.parametrize("gone", [0.05, 0.3, 0.7, 1.0])
def test_after_both_were_hidden_each_is_who_it_was(gone: float):
    watching = Watching()
    watching.tracker.follow(*place_of(ROBOT))
    watching.sees(ROBOT, TWIN, count=10)
    watching.sees_for(gone)
    assert is_at(watching.sees(ROBOT, TWIN, count=3), ROBOT)


def test_one_of_two_that_comes_out_long_after_is_only_taken_when_it_is_pointed_to():
    watching = Watching()
    watching.tracker.follow(*place_of(ROBOT))
    watching.sees(ROBOT, TWIN, count=10)
    watching.sees_for(ELSEWHERE_AFTER + 0.5)
    somewhere = replace(ROBOT, pose=Pose(-0.02, 0.03, 0.0))
    assert watching.sees(somewhere, count=60).measurement is None
    watching.tracker.follow(*place_of(somewhere))
    assert is_at(watching.sees(somewhere, count=3), somewhere)


def test_a_single_robot_that_was_carried_elsewhere_is_found_there():
    watching = Watching()
    watching.sees(ROBOT, count=10)
    elsewhere = replace(ROBOT, pose=Pose(-0.04, 0.03, 0.3))
    assert watching.sees_for(1.0, elsewhere).measurement is None
    assert is_at(watching.sees_for(ELSEWHERE_AFTER - 0.9, elsewhere), elsewhere)


def test_a_robot_that_is_touched_by_another_one_is_not_measured():
    watching = Watching()
    watching.sees(ROBOT, count=10)
    image = np.minimum(PAINTER.paint(ROBOT, 0), PAINTER.paint(replace(ROBOT, pose=Pose(0.0045, 0.0, 0.5)), 0))
    expected = Expectation(ROBOT.pose, 2e-4)
    observation = watching.tracker.update(Frame(image, 10 / RATE, 10), expected)
    assert observation.measurement is None
    assert observation.reason == COVERED


@pytest.mark.parametrize("share", [0.2, 0.35, 0.5])
def test_a_robot_that_is_covered_in_part_is_not_measured(share: float):
    watching = Watching()
    flat = replace(ROBOT, pose=Pose(0.0, 0.0, 0.5 * math.pi))
    watching.sees(flat, count=10)
    image, (u, v) = PAINTER.paint(flat, 0).copy(), place_of(flat)
    length = LENGTH * OPTICS.scale_at(0.0, 0.0, HEIGHT)
    edge = round(u + (0.5 - share) * length)
    image[round(v) - 30 : round(v) + 30, edge : edge + 60] = (140, 160, 200)
    for expected in (Expectation(flat.pose, 2e-4), None):
        observation = watching.tracker.update(Frame(image, 10 / RATE, 10), expected)
        assert observation.measurement is None


@pytest.mark.parametrize("gone", [0.1, 0.4, 0.7, 1.0])
@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_a_robot_that_turned_at_100_deg_per_s_while_hidden_keeps_head_and_tail(gone: float, direction: float):
    """Until 150 ms after the last sighting the estimator goes on to say how it turns; the rest is under 90 degrees."""
    watching, rate = Watching(heading_hint=0.4), direction * math.radians(100.0)
    watching.sees(ROBOT, count=5)
    for number in range(round(gone * RATE)):
        time = (number + 1) / RATE
        turned = replace(ROBOT.pose, heading=ROBOT.pose.heading + rate * time)
        watching.sees(expected=Expectation(turned, 3e-4) if time <= 0.15 else None)
    truth = replace(ROBOT, pose=replace(ROBOT.pose, heading=ROBOT.pose.heading + rate * gone))
    seen = watching.sees(truth, count=3).measurement
    assert seen is not None
    assert abs(wrap(seen.pose.heading - truth.pose.heading)) < math.radians(3.0)


def test_other_colours_are_used_at_once_and_the_robots_place_stays_known():
    watching = Watching()
    watching.sees(ROBOT, count=10)
    watching.tracker.retune(
        replace(TrackerSettings(), colour=replace(TrackerSettings().colour, saturation=(90, 255)))
    )
    assert is_at(watching.sees(ROBOT, expected=Expectation(ROBOT.pose, 2e-4)), ROBOT)
    green = replace(TrackerSettings(), colour=replace(TrackerSettings().colour, hue=(100, 140)))
    watching.tracker.retune(green)
    assert watching.sees(ROBOT, count=3).measurement is None


def along(distance: float) -> Body:
    """A robot like the first one, so far (m) ahead of it along its axis."""
    heading = ROBOT.pose.heading
    return replace(ROBOT, pose=Pose(-distance * math.sin(heading), distance * math.cos(heading), heading))


@pytest.mark.parametrize("which", [0, 1])
def test_a_robot_that_is_pointed_to_while_another_one_touches_it_is_the_one_when_they_part(which: int):
    """The blob of both has a middle that is neither's."""

    def show(*bodies: Body, times: range) -> list[Observation]:
        one, other = (PAINTER.paint(body, 0) for body in bodies)
        image = np.minimum(one, other)
        return [watching.tracker.update(Frame(image, index / RATE, index), None) for index in times]

    watching = Watching()
    touching, parted = (ROBOT, along(0.0097)), (ROBOT, along(0.0115))
    watching.tracker.follow(*place_of(touching[which]))
    assert all(each.measurement is None for each in show(*touching, times=range(5)))
    assert is_at(show(*parted, times=range(5, 8))[-1], parted[which])
