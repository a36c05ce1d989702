from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scripted_scene import HEIGHT, LENGTH, OPTICS, SCENE, anywhere

from control.model import PIVOT_A, Body, Expectation, Frame, Observation, Pose, Tracking, wrap
from vision.simulated.rendering import Painter
from vision.tracking.memory import ELSEWHERE_AFTER
from vision.tracking.reasons import AGAIN, ELSEWHERE, NOT_THERE
from vision.tracking.tracker import ColourTracker, TrackerSettings

PERIOD = 1 / 60
PAINTER = Painter(OPTICS, SCENE)
CENTRED = Body(Pose(0.010, -0.020, 0.4), PIVOT_A, 0.0)


def tracker(**settings) -> ColourTracker:
    return ColourTracker(OPTICS, TrackerSettings(**settings), LENGTH, HEIGHT)


def frame(body: Body | None, index: int) -> Frame:
    return Frame(PAINTER.paint(body, index), index * PERIOD, index)


def found(follower: ColourTracker, body: Body) -> Observation:
    """Three pictures of a robot of which nothing is known."""
    return [follower.update(frame(body, index), None) for index in range(3)][-1]


def expect(body: Body, sigma: float = 2e-4) -> Expectation:
    return Expectation(body.pose, sigma, body.pivot, body.tilt)


def pose_of(observation: Observation) -> Pose:
    assert observation.measurement is not None
    return observation.measurement.pose


def moved(body: Body, dx: float = 0.0, turn: float = 0.0) -> Body:
    return replace(body, pose=replace(body.pose, x=body.pose.x + dx, heading=body.pose.heading + turn))


@pytest.mark.parametrize("tilt", [0.0, math.radians(6.9), math.radians(15.0)])
def test_while_locked_the_pose_is_true_to_a_tenth_of_a_pixel_and_a_fraction_of_a_degree(tilt: float):
    random, follower = np.random.default_rng(21), tracker()
    offsets, turns = [], []
    for index in range(200):
        body = anywhere(random, tilt)
        guess = moved(body, dx=random.normal(0.0, 3e-4), turn=random.normal(0.0, 0.2))
        observation = follower.update(frame(body, index), expect(guess, 3e-4))
        assert observation.tracking is Tracking.LOCKED
        pose = pose_of(observation)
        scale = OPTICS.scale_at(body.pose.x, body.pose.y, HEIGHT)
        offsets.append(pose.distance_to(body.pose.x, body.pose.y) * scale)
        turns.append(abs(wrap(pose.heading - body.pose.heading)))
    assert np.mean(offsets) <= 0.1
    assert np.degrees(np.mean(turns)) <= 0.4


def test_the_measurement_carries_its_frames_capture_time_and_what_was_seen():
    observation = tracker().update(frame(CENTRED, 30), expect(CENTRED))
    seen = observation.measurement
    assert seen is not None
    assert seen.captured_at == 0.5
    assert math.dist(seen.centre_image, OPTICS.to_pixel(CENTRED.pose.x, CENTRED.pose.y, HEIGHT)) < 0.15
    assert len(seen.corners_image) == 4
    u0, v0, u1, v1 = observation.window
    assert all(u0 <= u <= u1 and v0 <= v <= v1 for u, v in seen.corners_image)


def test_the_window_grows_with_the_uncertainty_and_stays_in_the_picture():
    follower = tracker()
    sides = []
    for sigma in (1e-4, 1e-3, 5e-3, 1.0):
        u0, v0, u1, v1 = follower.update(frame(CENTRED, 0), expect(CENTRED, sigma)).window
        assert 0 <= u0 < u1 <= 640
        assert 0 <= v0 < v1 <= 480
        sides.append(u1 - u0)
    assert sides == sorted(set(sides))
    assert sides[0] < 90
    assert sides[-1] == 640


@pytest.mark.parametrize("place", [(0.3, 0.3), (-0.3, 0.0), (0.0, -9.0)])
def test_an_expectation_outside_the_picture_finds_nothing_and_breaks_nothing(place: tuple[float, float]):
    away = Expectation(Pose(*place, 0.0), 1e-4)
    assert tracker().update(frame(CENTRED, 0), away).measurement is None


def test_of_the_two_headings_the_expected_one_is_taken():
    for turn in (0.0, 1.0, -1.2, math.pi, math.pi + 1.0):
        observation = tracker().update(frame(CENTRED, 0), expect(moved(CENTRED, turn=turn)))
        flipped = math.cos(turn) < 0.0
        truth = CENTRED.pose.heading + (math.pi if flipped else 0.0)
        assert abs(wrap(pose_of(observation).heading - truth)) < 0.02


def test_without_an_expectation_the_last_heading_decides_and_before_it_the_hint():
    assert abs(wrap(pose_of(found(tracker(heading_hint=0.5), CENTRED)).heading - 0.4)) < 0.02
    follower = tracker(heading_hint=0.5 + math.pi)
    found(follower, CENTRED)
    for index in range(3, 40):
        body = moved(CENTRED, turn=0.1 * index)
        pose = pose_of(follower.update(frame(body, index), None))
        assert abs(wrap(pose.heading - body.pose.heading - math.pi)) < 0.03
    follower.reset()
    assert abs(wrap(pose_of(found(follower, CENTRED)).heading - 0.4 - math.pi)) < 0.02


def test_a_robot_anywhere_in_the_picture_is_found_without_an_expectation_at_the_third_picture():
    random = np.random.default_rng(22)
    for _ in range(40):
        follower, body = tracker(), anywhere(random)
        seen = [follower.update(frame(body, index), None) for index in range(3)]
        assert [each.tracking for each in seen] == [Tracking.LOST, Tracking.LOST, Tracking.LOCKED]
        assert seen[0].reason == seen[1].reason == AGAIN
        assert pose_of(seen[2]).distance_to(body.pose.x, body.pose.y) < 1e-4


def test_a_hidden_robot_is_predicted_for_150_ms_then_lost_and_found_at_the_second_picture_of_it():
    follower = tracker()
    assert follower.update(frame(None, 0), None).tracking is Tracking.LOST
    found(follower, CENTRED)
    for index in range(3, 30):
        observation = follower.update(frame(None, index), expect(CENTRED))
        gone = (index - 2) * PERIOD
        assert observation.tracking is (Tracking.PREDICTED if gone <= 0.15 + 1e-9 else Tracking.LOST)
        assert observation.measurement is None
        assert observation.reason == NOT_THERE
    assert follower.update(frame(CENTRED, 30), None).reason == AGAIN
    assert follower.update(frame(CENTRED, 31), None).tracking is Tracking.LOCKED


def test_an_empty_plate_never_yields_a_lock():
    follower = tracker()
    for index in range(200):
        expected = expect(CENTRED, 2e-3) if index % 2 else None
        assert follower.update(frame(None, index), expected).tracking is Tracking.LOST


def test_a_locked_window_fits_the_body_and_widens_with_its_speed():
    follower = tracker()
    found(follower, CENTRED)
    u0, v0, u1, v1 = follower.update(
        frame(CENTRED, 3), replace(expect(CENTRED, 1e-4), heading_sigma=0.02)
    ).window
    assert (u1 - u0) * (v1 - v0) < 62 * 62
    faster = moved(CENTRED, dx=0.004)
    expected = replace(expect(faster, 1e-4), heading_sigma=0.02)
    wide = follower.update(frame(faster, 4), expected).window
    assert wide[2] - wide[0] > u1 - u0 + 5


def test_a_blob_far_from_the_expected_place_is_not_taken_for_the_robot_before_it_may_have_been_carried_there():
    follower, far = tracker(), moved(CENTRED, dx=0.03)
    found(follower, CENTRED)
    for index in range(3, 12):
        observation = follower.update(frame(far, index), expect(CENTRED))
        assert observation.measurement is None
        assert observation.reason == ELSEWHERE
    taken_at = next(
        index for index in range(12, 200) if follower.update(frame(far, index), None).measurement is not None
    )
    assert ELSEWHERE_AFTER < (taken_at - 2) * PERIOD < ELSEWHERE_AFTER + 4 * PERIOD


def test_a_robot_that_was_pushed_is_not_where_it_is_expected_and_soon_found_where_it_is():
    follower, pushed = tracker(), moved(CENTRED, dx=0.005)
    found(follower, CENTRED)
    for index in range(3, 12):
        assert follower.update(frame(pushed, index), expect(CENTRED)).measurement is None
    seen = [follower.update(frame(pushed, index), None) for index in range(12, 14)]
    assert pose_of(seen[1]).distance_to(pushed.pose.x, pushed.pose.y) < 1e-4


def test_of_two_robots_the_one_at_the_expected_place_is_taken():
    picture = PAINTER.paint(CENTRED, 0).copy()
    other = PAINTER.paint(moved(CENTRED, dx=0.012), 0)
    u, v = (round(place) for place in OPTICS.to_pixel(CENTRED.pose.x + 0.012, CENTRED.pose.y, HEIGHT))
    picture[v - 24 : v + 24, u - 24 : u + 24] = other[v - 24 : v + 24, u - 24 : u + 24]
    both = Frame(picture, 0.0, 0)
    for body in (CENTRED, moved(CENTRED, dx=0.012)):
        pose = pose_of(tracker().update(both, expect(body, 3e-3)))
        assert pose.distance_to(body.pose.x, body.pose.y) < 1e-4


def test_a_robot_cut_by_the_pictures_edge_is_not_measured():
    cut = replace(CENTRED, pose=Pose(0.086, 0.0, 0.0))
    assert tracker().update(frame(cut, 0), None).measurement is None
    assert tracker().update(frame(cut, 0), expect(cut)).measurement is None


def test_a_round_blob_has_no_heading_and_is_not_taken():
    square = Painter(OPTICS, replace(SCENE, length=0.006, width=0.006))
    round_frame = Frame(square.paint(CENTRED, 0), 0.0, 0)
    assert tracker().update(round_frame, None).measurement is None


@pytest.mark.parametrize("shape", [(240, 320, 3), (480, 640)])
def test_a_picture_of_another_size_than_the_calibrations_is_not_looked_at(shape: tuple[int, ...]):
    assert tracker().update(Frame(np.zeros(shape, np.uint8), 0.0, 0), None).measurement is None


@pytest.mark.parametrize("wrong", [math.nan, math.inf])
def test_an_expectation_that_is_not_finite_counts_as_none(wrong: float):
    for expectation in (Expectation(replace(CENTRED.pose, x=wrong), 1e-4), Expectation(CENTRED.pose, wrong)):
        observation = tracker().update(frame(CENTRED, 0), expectation)
        assert observation.window == (0, 0, 640, 480)
        assert observation.reason == AGAIN


def test_a_heading_sigma_that_is_no_number_widens_the_window_and_breaks_nothing():
    follower = tracker()
    found(follower, CENTRED)
    expectation = replace(expect(CENTRED), heading_sigma=math.nan)
    assert pose_of(follower.update(frame(CENTRED, 3), expectation)).distance_to(0.010, -0.020) < 1e-4


def test_the_mask_shows_the_robot_and_nothing_else():
    mask = tracker().mask(PAINTER.paint(CENTRED, 0))
    u, v = (round(place) for place in OPTICS.to_pixel(CENTRED.pose.x, CENTRED.pose.y, HEIGHT))
    assert mask.shape == (480, 640)
    assert mask[v, u] == 255
    assert 300 < np.count_nonzero(mask) < 800
