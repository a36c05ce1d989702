"""`pivotrig calibrate gait` on the simulated rig, through pixels and bytes."""

import json
import math
from dataclasses import asdict
from pathlib import Path

import pytest
from typer.testing import CliRunner

from control.controllers import Decision, Situation, controllers
from control.gait import Gait
from control.gait_model import GaitModel, GaitUncertainty
from control.registry import Parameters
from control.runs import Choice, RunRequest, Selection
from control.simulation.slip import NO_SLIP, SLIP_TABLE, SlipParameters
from server.assembly import build_machine
from server.calibration.gait import Star, calibrate_gait, changes
from server.cli import app
from server.commands.calibration_result import toml_lines
from server.headless import run_headless
from server.rig_file import load_rig_file, merged
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
        "skew": 0.0,
    }


SHORT = Star(legs=3, leg=0.012)
"""A star for everyday: its standard errors are larger, and as honest."""


def calibrated(plant: str, tilt_deg: float, seed: int, star: Star) -> GaitModel:
    centre = {"start_x_mm": 0.0, "start_y_mm": 0.0}
    settings = RigFile().with_simulation(plant=plant, seed=seed, **centre)
    machine = build_machine(settings, realtime=False)
    gait = Gait(sweep=math.radians(30.0), tilt=math.radians(tilt_deg), max_rate=6.0)
    return calibrate_gait(machine, "star", gait, star).model


@pytest.mark.parametrize(("plant", "tilt_deg"), [("slip", 24.5), ("slip", 20.0), ("noslip", 25.0)])
def test_the_figures_agree_with_the_plant_within_three_standard_errors(
    plant: str, tilt_deg: float, full: bool
) -> None:
    true = true_figures(TABLES[plant], math.radians(tilt_deg))
    for seed in range(1, 11 if full else 2):
        model = asdict(calibrated(plant, tilt_deg, seed, Star() if full else SHORT))
        for name, value in true.items():
            error = model["uncertainty"][name]
            assert abs(model[name] - value) <= 3.0 * error, f"{name}, seed {seed}: {model[name]} ± {error}"


def test_the_uncertainties_are_small_enough_to_tell_a_slipping_robot_from_another() -> None:
    model = calibrated("slip", 24.5, 3, Star())
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
    rig_file = tmp_path / "rig.toml"
    rig_file.write_text("# kept\n")
    answer = CliRunner().invoke(app, [*star, "--rig", str(rig_file), "--save"])
    assert answer.exit_code == 0, answer.stderr
    assert "# kept" in rig_file.read_text()
    settings = load_rig_file(rig_file)
    assert settings.robot.length_mm == pytest.approx(10.0, abs=0.1)
    assert settings.estimator.backlash_deg > 1.0
    assert settings.gait.out_mm < -0.05
    assert settings.gait.source.startswith("measured 20")
    assert "length 0.0" in settings.gait.source
    seen = situations_of(settings)
    assert seen.slip is not None
    assert seen.slip.out == pytest.approx(settings.gait.out_mm * 1e-3)
    assert seen.slip.switch_time == pytest.approx(0.05)


def test_what_is_only_shown_can_be_copied_into_a_rig_file(tmp_path: Path) -> None:
    model = GaitModel(0.01, out=-0.0001, skew=0.05, uncertainty=GaitUncertainty(*[1e-4] * 8))
    rig_file = tmp_path / "rig.toml"
    rig_file.write_text("\n".join(toml_lines(changes(model, RigFile()))))
    settings = load_rig_file(rig_file)
    assert settings.gait.out_mm == pytest.approx(-0.1)
    assert settings.vision.heading_offset_deg == pytest.approx(math.degrees(0.05), abs=1e-3)


def turned_rig(offset_deg: float, rotation_deg: float) -> RigFile:
    """The coloured body lies askew on the pivots by -offset, and the coils stand turned; the rig file knows neither."""
    whole = RigFile().with_simulation(
        start_x_mm=0.0, start_y_mm=0.0, registration={"rotation_deg": rotation_deg}
    )
    return RigFile.model_validate(
        whole.model_dump(mode="json") | {"vision": {"heading_offset_deg": offset_deg}}
    )


def star_on(settings: RigFile) -> GaitModel:
    gait = Gait(sweep=math.radians(30.0), tilt=math.radians(25.0), max_rate=6.0)
    machine = build_machine(settings, realtime=False)
    return calibrate_gait(machine, "star", gait, Star(legs=3, leg=0.015)).model


TURNED = [(-3.0, 5.0), (4.0, 0.0), (0.0, -8.0), (10.0, 10.0)]
"""Heading offset that the rig file has wrongly, and rotation of the coils that it does not have, degrees."""


def test_after_saving_nothing_is_left_of_the_angles_between_field_pivots_and_body(full: bool) -> None:
    for offset_deg, rotation_deg in TURNED if full else TURNED[:1]:
        put_right(offset_deg, rotation_deg)


def put_right(offset_deg: float, rotation_deg: float) -> None:
    settings = turned_rig(offset_deg, rotation_deg)
    found = changes(star_on(settings), settings)
    saved = RigFile.model_validate(merged(settings.model_dump(mode="json"), found))
    assert saved.vision.heading_offset_deg == pytest.approx(0.0, abs=0.35)
    assert saved.coils.registration.rotation_deg == pytest.approx(rotation_deg, abs=0.6)
    again = star_on(saved)
    assert again.uncertainty is not None
    assert abs(again.skew) <= 3.0 * again.uncertainty.skew
    assert abs(again.heading_offset) <= 3.0 * again.uncertainty.heading_offset


def test_angles_that_may_be_chance_are_left_alone() -> None:
    model = GaitModel(0.01, heading_offset=0.001, skew=-0.001, uncertainty=GaitUncertainty(*[1e-3] * 8))
    assert not {"vision", "coils"} & set(changes(model, RigFile()))


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
