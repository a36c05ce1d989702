"""The rigid robot under the real controllers: in a batch, and in the complete rig with pixels and bytes."""

import json
import math

import pytest
from typer.testing import CliRunner

from control.studies.batch import plain_walk, simulate
from control.studies.definition import StudyDefinition
from control.studies.examples import examples
from server.cli import app

DEFINITION = {
    "name": "A short walk",
    "duration_s": 2.0,
    "trajectory": {"name": "circle"},
    "plant": {"name": "rigid"},
    "axes": [{"of": "gait.tilt_deg", "values": [25, 30]}],
}


def test_a_batch_walks_the_rigid_robot_and_gets_the_same_again() -> None:
    plan = StudyDefinition.from_json(DEFINITION).plan()
    runs = [plan.run(index) for index in range(2)]
    both = simulate(runs)
    metrics = plain_walk(runs[1])
    assert metrics == both[1]
    assert metrics.steps >= 1
    # Half of its length: it follows, slips and all.
    assert 0.0 < metrics.mean_error < 5e-3


def test_the_rigid_robot_walks_in_the_complete_rig() -> None:
    options = "--plant rigid --trajectory circle --duration 3 --no-record --json"
    answer = CliRunner().invoke(app, ["run", *options.split()])
    assert answer.exit_code == 0, answer.stderr
    result = json.loads(answer.stdout)
    assert result["state"] == "finished"
    assert result["steps"] >= 1
    # Its length.
    assert result["mean_error_mm"] < 10.0


def test_the_example_study_of_the_tilt_varies_lambda_and_the_ramp() -> None:
    definition = StudyDefinition.from_toml(examples()["rigid-tilt"])
    plan = definition.plan()
    ratios = {round(plan.run(index).plant.kind().parameters.magnetic_ratio(0.01), 1) for index in range(80)}  # type: ignore[attr-defined]
    assert ratios == {2.0, 2.6, 3.2, 7.0, 14.0}
    assert {plan.run(index).setup.ramp for index in range(80)} == {0.05, 0.15}
    tilts = {math.degrees(plan.run(index).selection.gait.tilt) for index in range(80)}
    assert sorted(tilts) == pytest.approx([10, 15, 20, 25, 30, 35, 40, 45])
