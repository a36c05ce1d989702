"""A walk whose settings change on the way: what was learned so far is kept unless the controller is another one."""

from dataclasses import replace

import pytest

from control.controllers import controllers
from control.gait_settings import GaitSettings
from control.model import PIVOT_A, Pose
from control.runs import Choice, RunRequest, Selection
from control.walk import Walk

SEQUENCE = Choice("sequence", {"table": "B 15 60; A -30 60", "repeat": True})
CHOSEN = Selection(controller=SEQUENCE)


@pytest.fixture
def walk() -> Walk:
    return Walk("a walk", RunRequest(CHOSEN), 0.010, PIVOT_A, Pose(0.0, -0.04, 0.0))


def test_another_gait_leaves_the_controller_where_it_is_in_its_work(walk):
    before = walk.walker.controller
    walk.change(replace(CHOSEN, gait=GaitSettings(sweep_deg=12.0).to_si()))
    assert walk.walker.controller is before
    assert walk.gait.sweep == pytest.approx(GaitSettings(sweep_deg=12.0).to_si().sweep)


def test_another_path_leaves_the_controller_as_well(walk):
    before = walk.walker.controller
    walk.change(replace(CHOSEN, trajectory=Choice("line")))
    assert walk.walker.controller is before


def test_other_parameters_make_another_controller(walk):
    before = walk.walker.controller
    walk.change(replace(CHOSEN, controller=replace(SEQUENCE, parameters={"table": "A 30 60"})))
    assert walk.walker.controller is not before


def test_the_schema_says_which_values_may_change_while_the_robot_walks():
    gait = GaitSettings.model_json_schema()["properties"]
    live = {name for name, field in gait.items() if field.get("live")}
    assert live >= {"sweep_deg", "tilt_deg", "field_mT", "max_rate_deg_s", "path_step_s"}
    assert not live & {"time_law", "approach"}


@pytest.mark.parametrize("name", ["sequence", "straight", "star", "wiggle", "to_pose"])
def test_a_controller_that_counts_its_own_steps_changes_only_with_the_next_run(name):
    """It would begin its walk anew."""
    properties = controllers[name].Parameters.model_json_schema()["properties"]
    assert not any(field.get("live") for field in properties.values())
