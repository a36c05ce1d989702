"""Heading hold and tables of turns, in pure kinematics."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import ValidationError

from control.controllers import controllers
from control.controllers.sequence import parse_table
from control.gait import Gait
from control.model import PIVOT_A, PIVOT_B, Pose, pivot_point, wrap
from control.simulation.kinematic import KinematicWalker
from control.trajectories import trajectories

LENGTH = 0.010
GAIT = Gait(sweep=math.radians(30.0))
TICK = 1.0 / 60.0


def walker(name: str, parameters: dict[str, object], heading: float = 0.0) -> KinematicWalker:
    controller = controllers.build(name, parameters)
    return KinematicWalker(controller, trajectories.build("line", {}), GAIT, Pose(0.0, 0.0, heading), LENGTH)


def walk_for(one: KinematicWalker, duration: float) -> None:
    for _ in range(round(duration / TICK)):
        one.advance(0.0, TICK)


@settings(max_examples=25)
@given(st.floats(-3.1, 3.1))
def test_hold_turns_to_its_heading_without_leaving_its_place(heading: float) -> None:
    one = walker("hold", {"heading_deg": math.degrees(heading), "tolerance_deg": 0.5})
    walk_for(one, 15.0)
    assert abs(math.degrees(wrap(one.pose.heading - heading))) <= 0.5
    assert one.pose.distance_to(0.0, 0.0) <= LENGTH * math.sin(GAIT.sweep / 2.0) + 1e-9


def test_hold_brings_a_disturbed_heading_back() -> None:
    one = walker("hold", {"heading_deg": 20.0})
    walk_for(one, 8.0)
    one.pose = Pose(one.pose.x, one.pose.y, one.pose.heading + 0.2)
    walk_for(one, 8.0)
    assert math.degrees(one.pose.heading) == pytest.approx(20.0, abs=0.5)


def test_a_sequence_makes_each_turn_of_its_table_about_the_given_pivot() -> None:
    one = walker("sequence", {"table": "A 20 60; B -25 90; A 10 30"})
    fixed = pivot_point(one.pose, PIVOT_A, LENGTH)
    walk_for(one, 20.0 / 60.0)
    assert one.pose.heading == pytest.approx(math.radians(20.0))
    assert pivot_point(one.pose, PIVOT_A, LENGTH) == pytest.approx(fixed)
    fixed = pivot_point(one.pose, PIVOT_B, LENGTH)
    walk_for(one, 16.0 / 60.0)
    assert pivot_point(one.pose, PIVOT_B, LENGTH) == pytest.approx(fixed)
    walk_for(one, 2.0)
    assert one.is_finished
    assert one.pose.heading == pytest.approx(math.radians(5.0))
    assert one.sweep.counts.steps == 2


def test_a_turn_wider_than_the_sweep_is_made_in_several() -> None:
    one = walker("sequence", {"table": "B 100 90"})
    fixed = pivot_point(one.pose, PIVOT_B, LENGTH)
    walk_for(one, 3.0)
    assert one.is_finished
    assert one.pose.heading == pytest.approx(math.radians(100.0))
    assert pivot_point(one.pose, PIVOT_B, LENGTH) == pytest.approx(fixed)
    assert one.sweep.counts.sweeps == 4


def test_a_repeated_sequence_never_ends() -> None:
    one = walker("sequence", {"table": "A 10 90; B -10 90", "repeat": True})
    walk_for(one, 5.0)
    assert not one.is_finished
    assert one.sweep.counts.steps > 30


@pytest.mark.parametrize(
    "table",
    ["", ";", "C 10 60", "A 10", "A 10 60 3", "A 0 60", "A nan 60", "A 10 inf", "A 10 -5", "A 1e9 60"],
)
def test_a_table_that_cannot_be_used_names_its_row(table: str) -> None:
    with pytest.raises(ValidationError, match="row"):
        controllers.build("sequence", {"table": table})


def test_rows_may_be_parted_by_lines() -> None:
    rows = parse_table("a 30 60\nB -30 60\n")
    assert [row.pivot for row in rows] == [PIVOT_A, PIVOT_B]
