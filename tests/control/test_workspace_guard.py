"""The margins of the workspace: outward is forbidden in time, inward always free."""

import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from control.model import PIVOT_A, PIVOT_B, Pose, swing
from control.workspace_guard import (
    ARC_STEP,
    LONGEST_ARC,
    TOLERANCE,
    WayBack,
    WorkspaceGuard,
    arc_to_stop,
    farthest,
    reach,
)

LENGTH = 0.010
SOFT, HARD = 0.062, 0.068
EAST, NORTH, WEST = 0.0, math.radians(90.0), math.radians(180.0)

places = st.floats(-0.08, 0.08)
headings = st.floats(-7.0, 7.0)
pivots = st.sampled_from([PIVOT_A, PIVOT_B])
arcs = st.floats(-7.0, 7.0)


def guard() -> WorkspaceGuard:
    return WorkspaceGuard(SOFT, HARD, LENGTH)


@given(places, places)
def test_the_reach_is_the_square_that_the_centre_lies_on(x: float, y: float) -> None:
    assert reach(Pose(x, y, 0.0)) == max(x, -x, y, -y)


@pytest.mark.parametrize("pose", [Pose(math.nan, 0, 0), Pose(0, math.inf, 0), Pose(0, 0, math.nan)])
def test_a_pose_that_is_none_is_endlessly_far_out(pose: Pose) -> None:
    assert reach(pose) == math.inf
    assert farthest(pose, PIVOT_A, 0.1, LENGTH) == math.inf
    assert guard().leads_out(pose, PIVOT_A, 0.0)


@pytest.mark.parametrize("arc", [math.nan, math.inf, -math.inf])
def test_an_arc_that_is_none_leads_out(arc: float) -> None:
    assert guard().leads_out(Pose(0.0, 0.0, 0.0), PIVOT_A, arc)


@given(places, places, headings, pivots, arcs)
def test_the_farthest_point_is_found_to_a_fiftieth_of_a_millimetre(
    x: float, y: float, heading: float, pivot, arc: float
) -> None:
    pose = Pose(x, y, heading)
    clipped = max(-2.0 * math.pi, min(2.0 * math.pi, arc))
    true = max(reach(swing(pose, pivot, clipped * k / 720.0, LENGTH)) for k in range(721))
    assert max(reach(pose), farthest(pose, pivot, arc, LENGTH)) == pytest.approx(true, abs=2e-5)


def test_an_arc_of_many_turns_goes_nowhere_new() -> None:
    pose = Pose(0.0, 0.0, 0.0)
    assert farthest(pose, PIVOT_A, 1e300, LENGTH) == pytest.approx(0.010, abs=2e-5)
    assert farthest(pose, PIVOT_A, -1e300, LENGTH) == pytest.approx(0.010, abs=2e-5)


def test_a_half_turn_reaches_out_in_its_middle() -> None:
    """About end A, above the centre: out to the side by half the length, and a length up at the end."""
    pose = Pose(0.060, 0.0, EAST)
    assert farthest(pose, PIVOT_A, math.radians(180.0), LENGTH) == pytest.approx(0.065, abs=2e-5)
    assert reach(swing(pose, PIVOT_A, math.radians(180.0), LENGTH)) == pytest.approx(0.060)


def test_the_numbers_are_those_of_a_robot_of_a_centimetre() -> None:
    """The sway of 10 degrees, and the bulge of an arc between two looks, at 10 mm between the pivots."""
    assert 0.005 * (1.0 - math.cos(math.radians(10.0))) < TOLERANCE < 1.5e-4
    assert 0.005 * (1.0 - math.cos(0.5 * ARC_STEP)) < 1.3e-5
    assert math.radians(360.0) == LONGEST_ARC


def test_no_motion_stays_where_it_is() -> None:
    assert farthest(Pose(0.01, 0.02, 0.3), PIVOT_A, 0.0, LENGTH) == 0.02


# The arc that is left when the coils are told to stop -------------------------------------------


@pytest.mark.parametrize(
    ("rate", "left", "expected"),
    [
        (2.0, 1.0, 0.2),
        (-2.0, -1.0, -0.2),
        (2.0, 0.1, 0.1),
        (-2.0, -0.1, -0.1),
        (2.0, -1.0, 0.0),
        (-2.0, 1.0, 0.0),
        (0.0, 1.0, 0.0),
        (2.0, 0.0, 0.0),
    ],
)
def test_the_body_turns_on_for_the_stopping_time_or_to_its_goal(rate, left, expected) -> None:
    assert arc_to_stop(rate, left, 0.1) == pytest.approx(expected)


def test_a_rate_that_is_none_leads_out() -> None:
    assert guard().leads_out(Pose(0, 0, 0), PIVOT_A, arc_to_stop(math.nan, 1.0, 0.1))
    assert guard().leads_out(Pose(0, 0, 0), PIVOT_A, arc_to_stop(1.0, math.nan, 0.1))


# The soft margin ---------------------------------------------------------------------------------


def test_inside_the_soft_margin_every_short_arc_is_free() -> None:
    for pivot in (PIVOT_A, PIVOT_B):
        for arc in (-0.2, 0.2):
            assert not guard().leads_out(Pose(0.060, 0.060, 0.3), pivot, arc)


def test_the_stopping_distance_counts() -> None:
    """Walking east at the edge: 11 degrees more are a millimetre more."""
    inside = Pose(SOFT - 0.0011, 0.0, EAST)
    assert not guard().leads_out(inside, PIVOT_A, math.radians(11.0))
    beyond = Pose(SOFT - 0.0009, 0.0, EAST)
    assert guard().leads_out(beyond, PIVOT_A, math.radians(11.0))
    assert not guard().leads_out(beyond, PIVOT_A, math.radians(-11.0)), "backwards is inward"


@pytest.mark.parametrize(("x", "y", "outward"), [
    (1.0, 0.0, EAST), (-1.0, 0.0, WEST), (0.0, 1.0, NORTH), (0.0, -1.0, -NORTH),
])  # fmt: skip
def test_every_edge_is_guarded(x: float, y: float, outward: float) -> None:
    pose = Pose(x * 0.0615, y * 0.0615, outward)
    for pivot in (PIVOT_A, PIVOT_B):
        ahead = 0.2 * pivot
        assert guard().leads_out(pose, pivot, ahead)
        assert not guard().leads_out(pose, pivot, -ahead)


def test_the_margin_itself_is_allowed_and_the_next_number_is_not() -> None:
    assert not guard().leads_out(Pose(SOFT, 0.0, EAST), PIVOT_A, 0.0)
    on_it = WorkspaceGuard(farthest(Pose(0.061, 0.0, EAST), PIVOT_A, 0.1, LENGTH), HARD, LENGTH)
    assert not on_it.leads_out(Pose(0.061, 0.0, EAST), PIVOT_A, 0.1)
    below = WorkspaceGuard(math.nextafter(on_it.soft_limit, 0.0), HARD, LENGTH)
    assert below.leads_out(Pose(0.061, 0.0, EAST), PIVOT_A, 0.1)


def test_beyond_the_margin_inward_is_free_and_outward_is_not() -> None:
    beyond = Pose(0.064, 0.0, EAST)
    assert guard().leads_out(beyond, PIVOT_A, 0.01)
    assert not guard().leads_out(beyond, PIVOT_A, -0.2)
    assert not guard().leads_out(beyond, PIVOT_A, 0.0)


@given(places, places, headings, pivots, st.floats(-0.35, 0.35))
def test_what_is_allowed_ends_inside_or_no_further_out(x, y, heading, pivot, arc) -> None:
    pose = Pose(x, y, heading)
    if not guard().leads_out(pose, pivot, arc):
        assert reach(swing(pose, pivot, arc, LENGTH)) <= max(SOFT, reach(pose))


@given(places, places, headings, pivots)
def test_along_an_edge_one_of_the_two_ways_is_always_free(x, y, heading, pivot) -> None:
    """Nobody is locked out, but across a corner, where both ways may lead out over one edge each."""
    assume(abs(abs(x) - abs(y)) > 0.001)
    pose, small = Pose(x, y, heading), math.radians(5.0)
    opened = guard()
    opened.energised(pose)
    assert not (opened.leads_out(pose, pivot, small) and opened.leads_out(pose, pivot, -small))


# The way back in ---------------------------------------------------------------------------------


def test_small_steps_do_not_creep_out() -> None:
    """Each step is smaller than the tolerance; together they would be a centimetre."""
    one, pose = guard(), Pose(SOFT, 0.0, EAST)
    one.energised(pose)
    for _ in range(1000):
        one.follow(pose)
        if one.leads_out(pose, PIVOT_A, 0.01):
            break
        pose = swing(pose, PIVOT_A, 0.01, LENGTH)
        pose = Pose(pose.x, 0.0, EAST)
    assert reach(pose) <= SOFT + TOLERANCE


def test_coils_that_come_on_beyond_the_soft_margin_give_no_more_than_the_tolerance() -> None:
    one = guard()
    one.energised(Pose(0.064, 0.0, EAST))
    assert one.soft_limit == 0.064 + TOLERANCE
    assert one.hard_limit == HARD
    one.follow(Pose(0.063, 0.0, EAST))
    assert one.soft_limit == 0.063 + TOLERANCE
    one.follow(Pose(0.064, 0.0, EAST))
    assert one.soft_limit == 0.063 + TOLERANCE, "what it has come inward is not given back"
    one.follow(Pose(0.0, 0.0, EAST))
    assert one.soft_limit == SOFT


def test_only_the_operator_opens_the_hard_margin_and_only_inward() -> None:
    one = guard()
    one.energised(Pose(0.070, 0.0, EAST))
    assert one.hard_limit == HARD
    one.resumed(Pose(0.070, 0.0, EAST))
    assert one.hard_limit == one.soft_limit == 0.070 + TOLERANCE
    one.follow(Pose(0.069, 0.0, EAST))
    assert one.hard_limit == 0.069 + TOLERANCE
    one.follow(Pose(0.0, 0.0, EAST))
    assert (one.soft_limit, one.hard_limit) == (SOFT, HARD)


def test_coils_that_go_off_close_the_way_back() -> None:
    one = guard()
    one.resumed(Pose(0.070, 0.0, EAST))
    one.rest()
    assert (one.soft_limit, one.hard_limit) == (SOFT, HARD)


def test_a_pose_that_is_none_opens_and_moves_nothing() -> None:
    nowhere = Pose(math.nan, 0.0, 0.0)
    way = WayBack(HARD)
    way.open(nowhere)
    assert way.limit == HARD
    way.open(Pose(0.0, -0.070, 0.0))
    for unknown in (nowhere, None):
        way.follow(unknown)
        assert way.limit == 0.070 + TOLERANCE
    way.open(nowhere)
    assert way.limit == HARD


@pytest.mark.parametrize(
    ("soft", "hard", "length"),
    [
        (0.0, 0.1, 0.01), (-0.1, 0.1, 0.01), (math.nan, 0.1, 0.01),
        (0.2, 0.1, 0.01), (0.05, math.inf, 0.01), (0.05, math.nan, 0.01),
        (0.05, 0.1, 0.0), (0.05, 0.1, math.inf), (0.05, 0.1, math.nan),
    ],
)  # fmt: skip
def test_margins_that_hold_nothing_are_refused(soft: float, hard: float, length: float) -> None:
    with pytest.raises(ValueError, match="the margins need"):
        WorkspaceGuard(soft, hard, length)


def test_both_margins_may_be_the_same() -> None:
    assert WorkspaceGuard(0.06, 0.06, LENGTH).hard_limit == 0.06
