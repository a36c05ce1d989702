"""How a viewer's eye is led, without a clock or a socket."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from control.coils import CoilSet
from server.scene.geometry import RobotSize, SceneGeometry
from server.scene.viewers.steering import DURATION, HELD, Steering
from server.scene.views import BEHIND_ROBOT, FIELD_OF_VIEW, VIEWS, Stand, less, plus, stand
from vision.camera_model import CameraModel

CAMERA = CameraModel.looking_down()
GEOMETRY = SceneGeometry(CoilSet(), 0.06, RobotSize(0.01, 0.004, 0.003), CAMERA)
HERE = Stand((0.0, -40.0, 30.0), (0.0, 0.0, 0.0))
ROBOT = (2.0, 1.0, 0.0)
FOLLOWED = Stand(plus(ROBOT, BEHIND_ROBOT), ROBOT)

SHARES = st.floats(0.0, 1.0)


def followed(*, now=0.0):
    """A steering that has arrived at the robot."""
    steering = Steering()
    steering.hear(HERE, now)
    steering.ask("follow", FOLLOWED, now, smooth=False)
    assert steering.step(ROBOT, now) == FOLLOWED
    steering.hear(FOLLOWED, now)
    return steering


@pytest.mark.parametrize("name", VIEWS)
@pytest.mark.parametrize("aspect", [0.6, 1.0, 2.4])
def test_every_view_looks_at_the_plate_and_keeps_its_horizon(name, aspect):
    found = stand(name, GEOMETRY, ROBOT, aspect)
    assert math.hypot(*found.look_at[:2]) < 6.0
    assert found.position[2] > 0.5
    ahead = less(found.look_at, found.position)
    lean = sum(a * b for a, b in zip(ahead, found.up, strict=True)) / found.distance
    assert abs(lean) < 0.95
    assert math.hypot(*found.up) == pytest.approx(1.0)


def test_a_narrow_window_is_looked_at_from_farther_away():
    wide, narrow = (stand("overview", GEOMETRY, ROBOT, aspect) for aspect in (1.5, 0.5))
    assert narrow.distance == pytest.approx(2.0 * wide.distance)


def test_from_above_the_view_is_as_high_as_the_cameras_picture():
    above = stand("above", GEOMETRY, ROBOT, 1.3)
    top = CAMERA.to_point(CAMERA.cx, 0.0)[1] * 100.0
    bottom = CAMERA.to_point(CAMERA.cx, CAMERA.size[1] - 1.0)[1] * 100.0
    seen = 2.0 * above.distance * math.tan(0.5 * FIELD_OF_VIEW)
    assert seen == pytest.approx(top - bottom, rel=0.03)


def test_without_a_camera_above_is_straight_above():
    bare = SceneGeometry(CoilSet(), 0.06, RobotSize(0.01, 0.004, 0.003))
    assert stand("above", bare, ROBOT, 1.0).position[:2] == (0.0, 0.0)


@given(SHARES)
def test_on_its_way_the_eye_comes_no_nearer_than_both_ends(share):
    goal = stand("above", GEOMETRY, ROBOT, 1.0)
    between = HERE.towards(goal, share)
    assert min(HERE.distance, goal.distance) - 1e-6 <= between.distance
    assert between.distance <= max(HERE.distance, goal.distance) + 1e-6


def test_a_smooth_view_arrives_in_time_and_a_plain_one_at_once():
    goal = stand("along", GEOMETRY, ROBOT, 1.0)
    for smooth in (True, False):
        steering = Steering()
        steering.hear(HERE, 0.0)
        steering.ask("along", goal, 0.0, smooth=smooth)
        first = steering.step(ROBOT, 0.0)
        assert (first == goal) is not smooth
        if smooth:
            last = steering.step(ROBOT, DURATION)
            assert last is not None
            assert last.position == pytest.approx(goal.position)
        assert not steering.busy
        assert steering.step(ROBOT, 2.0 * DURATION) is None


def test_an_eye_that_nobody_has_seen_goes_there_at_once():
    steering = Steering()
    goal = stand("along", GEOMETRY, ROBOT, 1.0)
    steering.ask("along", goal, 0.0, smooth=True)
    assert steering.step(None, 0.0) == goal


def test_who_follows_keeps_the_robot_in_the_middle_from_the_same_side():
    steering = followed()
    assert steering.step(ROBOT, 1.0) is None
    moved = (2.5, 1.2, 0.0)
    led = steering.step(moved, 1.1)
    assert led is not None
    assert led.look_at == moved
    assert less(led.position, led.look_at) == pytest.approx(BEHIND_ROBOT)


def test_who_turns_the_view_meanwhile_is_let_alone_and_keeps_the_new_side():
    steering = followed()
    turned = Stand(plus(ROBOT, (9.0, 0.0, 9.0)), ROBOT)
    steering.hear(turned, 1.0)
    assert steering.step((3.0, 1.0, 0.0), 1.0 + 0.5 * HELD) is None
    led = steering.step((3.0, 1.0, 0.0), 1.0 + 2.0 * HELD)
    assert led is not None
    assert less(led.position, led.look_at) == pytest.approx((9.0, 0.0, 9.0))


def test_the_echo_of_its_own_lead_is_not_taken_for_a_hand():
    steering = followed()
    for step in range(1, 10):
        robot = (2.0 + 0.1 * step, 1.0, 0.0)
        led = steering.step(robot, 1.0 + 0.05 * step)
        assert led is not None
        steering.hear(led, 1.0 + 0.05 * step)


def test_another_view_ends_the_following():
    steering = followed()
    steering.ask("overview", stand("overview", GEOMETRY, ROBOT, 1.0), 1.0, smooth=False)
    steering.step(ROBOT, 1.0)
    assert not steering.follows
    assert steering.step((5.0, 5.0, 0.0), 5.0) is None


def test_a_lost_robot_is_not_followed():
    assert followed().step(None, 1.0) is None
