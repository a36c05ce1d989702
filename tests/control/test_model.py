"""The pivot kinematics: exact arcs."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from control.model import PIVOT_A, PIVOT_B, Pivot, Pose, body_tilt, pivot_point, swing, wrap

LENGTH = 0.010
coordinate = st.floats(-0.06, 0.06)
angle = st.floats(-50.0, 50.0)
poses = st.builds(Pose, coordinate, coordinate, angle)
pivots = st.sampled_from((PIVOT_A, PIVOT_B))


@given(poses, pivots, angle)
def test_a_swing_keeps_its_pivot_in_place(pose: Pose, pivot: Pivot, turn: float) -> None:
    before = pivot_point(pose, pivot, LENGTH)
    after = pivot_point(swing(pose, pivot, turn, LENGTH), pivot, LENGTH)
    assert after == pytest.approx(before, abs=1e-15)


@given(poses, pivots, st.lists(st.floats(-3.0, 3.0), min_size=1, max_size=20))
def test_many_small_swings_are_one_large_one(pose: Pose, pivot: Pivot, turns: list[float]) -> None:
    stepwise = pose
    for turn in turns:
        stepwise = swing(stepwise, pivot, turn, LENGTH)
    at_once = swing(pose, pivot, sum(turns), LENGTH)
    assert (stepwise.x, stepwise.y) == pytest.approx((at_once.x, at_once.y), abs=1e-12)


@given(poses)
def test_the_pivots_are_a_length_apart_with_the_centre_between_them(pose: Pose) -> None:
    a, b = pivot_point(pose, PIVOT_A, LENGTH), pivot_point(pose, PIVOT_B, LENGTH)
    assert math.dist(a, b) == pytest.approx(LENGTH, rel=1e-9)
    assert ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2) == pytest.approx((pose.x, pose.y), abs=1e-12)


def test_the_rate_of_a_small_swing_is_the_papers_equation_1() -> None:
    pose, step = Pose(0.01, -0.02, 0.7), 1e-7
    after = swing(pose, PIVOT_A, step, LENGTH)
    assert (after.x - pose.x) / step == pytest.approx(LENGTH / 2 * math.cos(0.7), rel=1e-5)
    assert (after.y - pose.y) / step == pytest.approx(LENGTH / 2 * math.sin(0.7), rel=1e-5)


@given(angle)
def test_wrapping_keeps_the_direction(value: float) -> None:
    wrapped = wrap(value)
    assert -math.pi <= wrapped < math.pi
    assert math.cos(wrapped - value) == pytest.approx(1.0, abs=1e-9)


def test_the_body_rises_by_7_degrees_where_the_field_stands_at_25() -> None:
    assert math.degrees(body_tilt(math.radians(25.0), 3.2)) == pytest.approx(6.9, abs=0.05)


@given(st.floats(0.0, 1.2), st.floats(0.5, 10.0))
def test_the_raised_body_balances_torque_and_weight(elevation: float, ratio: float) -> None:
    tilt = body_tilt(elevation, ratio)
    if ratio * math.sin(elevation) <= 1.0:
        assert tilt == 0.0
    else:
        assert ratio * math.sin(elevation - tilt) == pytest.approx(math.cos(tilt), abs=1e-9)
