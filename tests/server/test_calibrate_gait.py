"""`pivotrig calibrate gait` on the simulated rig, through pixels and bytes."""

import json
import math
from dataclasses import asdict
from pathlib import Path

import pytest
from typer.testing import CliRunner

from control.controllers import Decision, Situation, controllers
from control.gait import Gait
from control.gait_model import GaitModel
from control.registry import Parameters
from control.runs import Choice, RunRequest, Selection
from control.simulation.slip import NO_SLIP, SLIP_TABLE, SlipParameters
from server.assembly import build_machine
from server.cli import app
from server.gait_calibration import Star, calibrate_gait
from server.headless import run_headless
from server.rig_file import load_rig_file
from server.settings import RigFile

LENGTH = 0.010
TABLES = {"slip": SLIP_TABLE, "noslip": NO_SLIP}


def true_figures(table: SlipParameters, tilt: float) -> dict[str, float]:
    row = table.at(tilt, LENGTH)
    return {
        "length": LENGTH,
        "out": row.out,
        "forward_base": row.forward_base,
        "forward_per_sweep": row.forward_per_sweep,
        "backlash": row.play,
        "heading_offset": 0.0,
    }


def calibrated(plant: str, tilt_deg: float, seed: int) -> GaitModel:
    centre = {"start_x_mm": 0.0, "start_y_mm": 0.0}
    settings = RigFile().with_simulation(plant=plant, seed=seed, **centre)
    machine = build_machine(settings, realtime=False)
    gait = Gait(sweep=math.radians(30.0), tilt=math.radians(tilt_deg), max_rate=6.0)
    return calibrate_gait(machine, "star", gait, Star()).model


@pytest.mark.parametrize(("plant", "tilt_deg"), [("slip", 24.5), ("slip", 20.0), ("noslip", 25.0)])
def test_the_figures_agree_with_the_plant_within_three_standard_errors(
    plant: str, tilt_deg: float, full: bool
) -> None:
    true = true_figures(TABLES[plant], math.radians(tilt_deg))
    for seed in range(1, 11 if full else 2):
        model = asdict(calibrated(plant, tilt_deg, seed))
        for name, value in true.items():
            error = model["uncertainty"][name]
            assert abs(model[name] - value) <= 3.0 * error, f"{name}, seed {seed}: {model[name]} ± {error}"


def test_the_uncertainties_are_small_enough_to_tell_a_slipping_robot_from_another() -> None:
    model = calibrated("slip", 24.5, 3)
    assert model.uncertainty is not None
    assert model.out < -3.0 * model.uncertainty.out
    assert model.forward_per_sweep > 3.0 * model.uncertainty.forward_per_sweep
    assert model.backlash > 6.0 * model.uncertainty.backlash


def test_the_command_prints_each_figure_with_its_standard_error() -> None:
    answer = CliRunner().invoke(
        app, ["calibrate", "gait", "--legs", "2", "--leg", "12", "--seed", "2", "--json"]
    )
    assert answer.exit_code == 0, answer.stderr
    result = json.loads(answer.stdout)
    assert result["figures"]["length_mm"]["value"] == pytest.approx(10.0, abs=0.1)
    assert all(figure["standard_error"] > 0.0 for figure in result["figures"].values())
    assert result["steps"] > 10


def test_what_was_found_goes_into_the_rig_file_and_from_there_to_the_controller(tmp_path: Path) -> None:
    star = ["calibrate", "gait", "--legs", "2", "--leg", "12", "--seed", "2"]
    answer = CliRunner().invoke(app, star)
    assert answer.exit_code == 0, answer.stderr
    rig_file = tmp_path / "rig.toml"
    rig_file.write_text(answer.stdout.split("for the rig file:\n")[1])
    settings = load_rig_file(rig_file)
    assert settings.robot.length_mm == pytest.approx(10.0, abs=0.1)
    assert settings.gait.out_mm < -0.05
    seen = situations_of(settings)
    assert seen.slip is not None
    assert seen.slip.out == pytest.approx(settings.gait.out_mm * 1e-3)
    assert seen.slip.switch_time == pytest.approx(0.05)


def situations_of(settings: RigFile) -> Situation:
    """What a controller is told on this rig."""
    told: list[Situation] = []

    class Curious:
        name = "curious"
        title = summary = "looks"
        Parameters = Parameters

        def __init__(self, _: Parameters) -> None: ...

        def step(self, situation: Situation) -> Decision:
            told.append(situation)
            return Decision(situation.pivot, 0.0, finished=True)

    controllers.register(Curious)
    try:
        request = RunRequest(Selection(Choice("curious")))
        run_headless(build_machine(settings, realtime=False), "curious", request)
    finally:
        controllers.forget("curious")
    return told[-1]


@pytest.mark.parametrize(
    ("arguments", "status", "complaint"),
    [
        (["--sweep", "0"], 2, "sweep_deg"),
        (["--tilt", "75"], 2, "tilt_deg"),
        (["--plant", "rubber"], 2, "plant"),
        (["--leg", "50"], 3, "leaves no room for the star"),
    ],
)
def test_what_cannot_be_calibrated_is_explained(arguments: list[str], status: int, complaint: str) -> None:
    answer = CliRunner().invoke(app, ["calibrate", "gait", *arguments])
    assert answer.exit_code == status
    assert complaint in " ".join(answer.stderr.split())
