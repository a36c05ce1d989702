"""Others that come so near that the pictures of two robots run into one, and hands that uncover a part."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scene_follower import SceneFollower
from scripted_scene import HEIGHT, LENGTH, OPTICS, SCENE

from control.model import PIVOT_A, Body, Expectation, Frame, Pose
from vision.simulated.figures import Figure
from vision.simulated.rendering import Extras, Painter
from vision.simulated.scenes import Shown
from vision.tracking.detection import RegionFilter, find
from vision.tracking.memory import ELSEWHERE_AFTER, FORGOTTEN_AFTER
from vision.tracking.reasons import COVERED
from vision.tracking.settings import RED
from vision.tracking.tracker import ColourTracker, TrackerSettings

RATE = 60
PAINTER = Painter(OPTICS, SCENE)
ROBOT = Body(Pose(0.0, 0.0, 0.4), PIVOT_A, 0.0)
SAME = 0.001
"""A sighting further than that from the robot's centre is of another one, or of both together, m."""
HAND_COLOUR = (140, 160, 200)

Path = Callable[[float], Body]


def tracker() -> ColourTracker:
    return ColourTracker(OPTICS, TrackerSettings(heading_hint=ROBOT.pose.heading), LENGTH, HEIGHT)


def shown(index: int, *others: Body) -> Shown:
    """The robot, and others in front of it."""
    extras = Extras(company=tuple(Figure((other,), SCENE.look) for other in others))
    return Shown(Frame(PAINTER.paint(ROBOT, index, extras), index / RATE, index), ROBOT, 1.0)


def beside(distance: float) -> Body:
    """Another one that stands parallel to the robot."""
    heading = ROBOT.pose.heading
    return replace(ROBOT, pose=Pose(distance * math.cos(heading), distance * math.sin(heading), heading))


def carried(speed: float, direction: float, aside: float) -> Path:
    """Straight over the robot from 40 mm before it on, `aside` (m) of its middle."""
    along, across = math.cos(direction), math.sin(direction)

    def path(time: float) -> Body:
        way = speed * time - 0.040
        place = way * along - aside * across, way * across + aside * along
        return Body(Pose(*place, direction + 0.6), PIVOT_A, 0.0)

    return path


@pytest.mark.parametrize("which", [0, 1])
@pytest.mark.parametrize("distance", [0.0045, 0.006])
def test_a_click_on_one_of_two_side_by_side_takes_that_one(distance: float, which: int):
    """On the coarse grid of the first look they are one blob."""
    watching, meant = tracker(), (ROBOT, beside(distance))[which]
    watching.follow(*OPTICS.to_pixel(meant.pose.x, meant.pose.y, HEIGHT))
    seen = [watching.update(shown(index, beside(distance)).frame, None).measurement for index in range(6)]
    assert seen[-1] is not None
    assert all(each is None or each.pose.distance_to(meant.pose.x, meant.pose.y) < SAME for each in seen)


@pytest.mark.parametrize("speed", [0.020, 0.030, 0.100])
@pytest.mark.parametrize(("direction", "aside"), [(0.7, -0.002), (1.6, -0.001), (2.5, 0.0)])
def test_another_one_that_is_carried_over_the_robot_does_not_take_it_along(
    speed: float, direction: float, aside: float
):
    watching, path = tracker(), carried(speed, direction, aside)
    follower = SceneFollower(watching)
    watching.follow(*OPTICS.to_pixel(0.0, 0.0, HEIGHT))
    for index in range(0, round(0.080 / speed * RATE)):
        seen = follower.look(shown(index, path(index / RATE))).measurement
        assert seen is None or seen.pose.distance_to(0.0, 0.0) < SAME, f"frame {index}"


@pytest.mark.parametrize("gone", [0.3, ELSEWHERE_AFTER + 0.5, FORGOTTEN_AFTER - 0.5])
def test_a_part_that_a_hand_leaves_free_is_not_taken_for_the_whole_robot(gone: float):
    watching, flat = tracker(), replace(ROBOT, pose=Pose(0.0, 0.0, 0.5 * math.pi))
    whole, (u, v) = PAINTER.paint(flat, 0), OPTICS.to_pixel(0.0, 0.0, HEIGHT)
    for index in range(8):
        assert watching.update(Frame(whole, index / RATE, index), None) is not None
    part, edge = whole.copy(), round(u + 0.25 * LENGTH * OPTICS.scale_at(0.0, 0.0, HEIGHT))
    part[round(v) - 30 : round(v) + 30, edge : edge + 60] = HAND_COLOUR
    covered = [watching.update(Frame(part, index / RATE + gone, index), None) for index in range(8, 16)]
    assert all(each.measurement is None for each in covered)
    assert covered[-1].reason == COVERED
    free = [watching.update(Frame(whole, index / RATE + gone, index), None) for index in range(16, 19)]
    assert free[-1].measurement is not None


def test_all_blobs_of_a_picture_share_one_list_of_who_is_there():
    """A list for each would cost the square of their number in a picture full of specks."""
    image = np.full((200, 200, 3), 200, np.uint8)
    image[::20, ::20] = image[1::20, ::20] = (40, 40, 190)
    blobs = find(image, (0, 0, 200, 200), RED, RegionFilter(1.0, 9.0))
    assert len(blobs) > 50
    assert all(blob.company is blobs[0].company for blob in blobs)
    assert all(len(blob.others) == len(blob.company) - 1 for blob in blobs)


@settings(deadline=None)
@given(
    st.tuples(st.floats(), st.floats(), st.floats()),
    st.tuples(st.floats(), st.floats(), st.floats()),
)
def test_whatever_is_expected_a_picture_is_looked_at(
    pose: tuple[float, float, float], rest: tuple[float, float, float]
):
    watching = tracker()
    for index in range(4):
        watching.update(shown(index).frame, None)
    sigma, tilt, heading_sigma = rest
    expected = Expectation(Pose(*pose), sigma, PIVOT_A, tilt, heading_sigma)
    seen = watching.update(shown(5).frame, expected).measurement
    assert seen is None or seen.pose.distance_to(0.0, 0.0) < SAME
