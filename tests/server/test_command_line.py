"""`pivotrig run`: one run, one answer."""

import json
import subprocess
import sys
from typing import Any

import pytest
from typer.testing import CliRunner

from server.cli import app

RUN = [sys.executable, "-m", "server", "run"]
EIGHT = ["--controller", "geometric", "--trajectory", "eight", "--sweep", "10", "--tilt", "25", "--json"]
EIGHT_LASTS = 125.66
"""A pass at a path step of 0.1 s, s."""
PART = 30.0
"""Seconds of the eight without slip in the everyday run of the tests."""


def run(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([*RUN, *arguments], capture_output=True, text=True, timeout=280, check=False)


def result(*arguments: str) -> dict[str, Any]:
    """In this process: to start one takes longer than most of these walks."""
    answer = CliRunner().invoke(app, ["run", *EIGHT, *arguments])
    assert answer.exit_code == 0, answer.stderr
    return json.loads(answer.stdout)


@pytest.mark.parametrize(("plant", "allowed_mm"), [("noslip", 3.0), ("slip", 4.0)])
def test_the_eight_is_walked_within_the_allowed_error(plant: str, allowed_mm: float, full: bool) -> None:
    duration = EIGHT_LASTS if full or plant == "slip" else PART
    metrics = result("--duration", str(duration), "--seed", "1", "--plant", plant)
    assert metrics["state"] == "finished"
    assert metrics["mean_error_mm"] <= allowed_mm
    assert metrics["normalized_mean_error"] == pytest.approx(metrics["mean_error_mm"] / 10.0, abs=1e-6)
    assert metrics["ticks"] == pytest.approx(duration * 60, abs=3)
    assert metrics["sweeps"] >= metrics["steps"] > 100 * duration / EIGHT_LASTS


def test_the_same_seed_gives_the_same_result_to_the_last_digit_in_another_process_too() -> None:
    arguments = ("--duration", "8", "--seed", "5")
    first, second = result(*arguments), json.loads(run(*EIGHT, *arguments).stdout)
    for measured in ("wall_s", "run_id"):
        first.pop(measured)
        second.pop(measured)
    assert first == second


def test_another_seed_gives_another_result() -> None:
    first, second = (result("--duration", "4", "--seed", seed) for seed in ("5", "6"))
    assert first["mean_error_mm"] != second["mean_error_mm"]


def test_a_longer_path_step_passes_the_path_sooner() -> None:
    slow, quick = (result("--passes", "0.05", "--path-step", step) for step in ("0.1", "0.2"))
    assert slow["duration_s"] == pytest.approx(0.05 * 125.66, abs=0.05)
    assert quick["duration_s"] == pytest.approx(0.025 * 125.66, abs=0.05)


def test_without_json_the_figures_are_a_table() -> None:
    answer = run("--duration", "2")
    assert answer.returncode == 0
    assert "mean_error_mm" in answer.stdout


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["--controller", "fuzzy"], "no controller called 'fuzzy'; choose one of: geometric"),
        (["--trajectory", "nine"], "no trajectory called 'nine'"),
        (["--set", "controller.gain=nan"], "gain"),
        (["--set", "controller.gain=-1"], "gain"),
        (["--set", "controller.speed=1"], "speed"),
        (["--set", "gain=1"], "--set 'gain=1' is not understood"),
        (["--sweep", "0"], "sweep_deg"),
        (["--sweep", "nan"], "sweep_deg"),
        (["--tilt", "89"], "tilt_deg"),
        (["--path-step", "-0.1"], "path_step_s"),
        (["--duration", "-3"], "duration_s"),
        (["--plant", "rubber"], "plant"),
        (["--trajectory", "circle", "--set", "trajectory.radius_mm=70"], "the workspace ends at ±60 mm"),
        (["--rig", "/nowhere/rig.toml"], "No such file"),
    ],
)
def test_wrong_usage_is_explained_and_ends_with_status_2(arguments: list[str], complaint: str) -> None:
    answer = CliRunner().invoke(app, ["run", "--json", *arguments])
    assert answer.exit_code == 2
    assert complaint in answer.stderr
    assert answer.stdout == ""


def test_a_process_ends_with_the_same_status_and_no_traceback() -> None:
    answer = run("--json", "--controller", "fuzzy")
    assert (answer.returncode, answer.stdout) == (2, "")
    assert answer.stderr.startswith("pivotrig: there is no controller called 'fuzzy'")
    assert "Traceback" not in answer.stderr
