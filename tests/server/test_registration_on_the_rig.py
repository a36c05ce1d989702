"""`pivotrig calibrate polarity` and `registration` on the simulated rig: through pixels, bytes and the coil map."""

import json
import math

import pytest
from typer.testing import CliRunner

from control.calibration.bench import Bench, BenchSettings
from control.calibration.robot_turn import RobotTurn
from control.calibration.verdict import Cause
from control.gait import Gait
from control.model import wrap
from control.runs import Choice, RunRequest, Selection
from control.snapshot import Snapshot
from server.assembly import build_machine
from server.cli import app
from server.commands.calibrate_registration import Picture, at_the_centre, turn
from server.headless import run_headless
from server.rig_file import load_rig_file
from server.settings import RigFile
from vision.simulated.camera import SyntheticCamera

TRUE = {"x_mm": 6.0, "y_mm": -4.0, "rotation_deg": 14.0, "magnet_reversed": False}
SETTINGS = BenchSettings(time_to_live=0.15, field_slew=0.01 / 0.3, max_field=0.015)


def verdict_on(mirrored: bool = False, picture: Picture | None = None, **simulation) -> tuple[Cause, ...]:
    machine = build_machine(at_the_centre(RigFile().with_simulation(**simulation)), realtime=False)
    if mirrored:
        assert isinstance(machine.camera, SyntheticCamera)
        machine.camera.disturbance.mirrored = True
    try:
        machine.open()
        with Bench(machine.camera, machine.loop.parts, SETTINGS) as bench:
            bench.wait_until_ready()
            robot = RobotTurn(bench, machine.tracker)
            return turn(machine, robot, picture, whole_circle=False).verdict.causes
    finally:
        machine.close()


@pytest.mark.parametrize(
    ("wiring", "cause"),
    [
        (["x", "y", "z"], Cause.NONE),
        (["-x", "y", "z"], Cause.X_SWAPPED),
        (["x", "-y", "z"], Cause.Y_SWAPPED),
        (["x", "y", "-z"], Cause.Z_SWAPPED),
        (["y", "x", "z"], Cause.XY_EXCHANGED),
    ],
)
@pytest.mark.parametrize("heading", [90.0, 35.0])
def test_a_fault_of_the_wiring_is_named_by_how_the_robot_turns(wiring, cause, heading):
    causes = verdict_on(wiring=wiring, start_heading_deg=heading, picture=Picture.RIGHT)
    assert causes == (cause,)


@pytest.mark.parametrize("coil", [1, 2, 3])
def test_leads_swapped_at_the_board_are_named_as_well(coil):
    machine = build_machine(at_the_centre(RigFile()), realtime=False)
    try:
        machine.open()
        machine.world.board.set_condition("swapped", 1, coil)  # type: ignore[union-attr]
        with Bench(machine.camera, machine.loop.parts, SETTINGS) as bench:
            bench.wait_until_ready()
            robot = RobotTurn(bench, machine.tracker)
            causes = turn(machine, robot, Picture.RIGHT, whole_circle=False).verdict.causes
        assert causes == ((Cause.X_SWAPPED, Cause.Y_SWAPPED, Cause.Z_SWAPPED)[coil - 1],)
    finally:
        machine.close()


def test_a_reversed_magnet_is_told_from_a_turned_camera():
    assert verdict_on(registration={"magnet_reversed": True}) == (Cause.MAGNET_REVERSED,)
    assert verdict_on(registration={"rotation_deg": 180.0}) == (Cause.TURNED,)
    assert verdict_on(registration={"rotation_deg": -25.0}) == (Cause.TURNED,)


def test_a_mirrored_picture_is_named_once_somebody_has_looked():
    assert Cause.MIRRORED in verdict_on(mirrored=True)
    assert verdict_on(mirrored=True, picture=Picture.MIRRORED) == (Cause.MIRRORED,)


def true_section(**changes) -> str:
    values = {**TRUE, **changes}
    lines = [f"{name} = {str(value).lower()}" for name, value in values.items()]
    return "\n".join(["[simulation.registration]", *lines, ""])


@pytest.mark.parametrize(
    "changes", [{}, {"magnet_reversed": True}, {"rotation_deg": 170.0}, {"rotation_deg": -95.0}]
)
def test_the_registration_finds_where_the_coils_stand_and_saves_it(tmp_path, changes):
    rig = tmp_path / "rig.toml"
    rig.write_text(true_section(**changes))
    command = ["calibrate", "registration", "--at-centre-mark", "--rig", str(rig), "--save", "--json"]
    answer = CliRunner().invoke(app, command)
    assert answer.exit_code == 0, answer.stderr
    assert json.loads(answer.stdout)["residual_deg"] < 1.0
    found, true = load_rig_file(rig).coils.registration, {**TRUE, **changes}
    assert (found.x_mm, found.y_mm) == pytest.approx((true["x_mm"], true["y_mm"]), abs=0.1)
    error = (found.rotation_deg - true["rotation_deg"] + 180.0) % 360.0 - 180.0
    assert abs(error) < 0.3
    assert found.magnet_reversed is true["magnet_reversed"]


def test_a_second_registration_finds_nothing_left_to_do(tmp_path):
    rig = tmp_path / "rig.toml"
    known = true_section().replace("[simulation.", "[coils.")
    rig.write_text(known + true_section())
    answer = CliRunner().invoke(app, ["calibrate", "registration", "--rig", str(rig), "--json"])
    assert answer.exit_code == 0, answer.stderr
    result = json.loads(answer.stdout)
    assert result["causes"] == ["none"]
    assert result["registration"]["rotation_deg"] == pytest.approx(TRUE["rotation_deg"], abs=0.2)


def test_an_entered_centre_is_taken_as_it_is(tmp_path):
    rig = tmp_path / "rig.toml"
    rig.write_text("")
    command = ["calibrate", "registration", "--x-mm", "3.5", "--y-mm", "-2", "--rig", str(rig), "--json"]
    answer = CliRunner().invoke(app, command)
    assert answer.exit_code == 0, answer.stderr
    found = json.loads(answer.stdout)["registration"]
    assert (found["x_mm"], found["y_mm"]) == (3.5, -2.0)


def test_a_rig_that_is_wired_wrongly_is_not_registered(tmp_path):
    rig = tmp_path / "rig.toml"
    rig.write_text('[simulation]\nwiring = ["-x", "y", "z"]\n')
    for command in ("polarity", "registration"):
        answer = CliRunner().invoke(app, ["calibrate", command, "--rig", str(rig)])
        assert answer.exit_code == 1
        assert "the x coils' leads are swapped" in answer.stdout + answer.stderr


def with_registration(true: dict, believed: dict) -> RigFile:
    settings = RigFile().with_simulation(registration=true).model_dump(mode="json")
    settings["coils"]["registration"] = believed
    return RigFile.model_validate(settings)


class Walked:
    """A stretch of the eight. error: mean distance from the path, m.  offset: of the body from the field, rad."""

    def __init__(self, settings: RigFile, full: bool) -> None:
        gait = Gait(sweep=math.radians(10.0), tilt=math.radians(30.0))
        selection = Selection(Choice("geometric"), Choice("eight"), gait)
        self._machine = build_machine(settings, realtime=False)
        self._turned: list[float] = []
        request = RunRequest(selection, duration=None if full else 20.0)
        done = run_headless(self._machine, "registration", request, self._watch)
        self.error = done.ended.metrics.mean_error or math.nan
        self.offset = sum(self._turned) / len(self._turned)

    def _watch(self, snapshot: Snapshot) -> None:
        seen = snapshot.observation.measurement if snapshot.observation is not None else None
        if snapshot.run is not None and seen is not None:
            field, _ = self._machine.loop.field_at(seen.captured_at)
            self._turned.append(wrap(seen.pose.heading - field))


def test_a_wrong_centre_costs_accuracy_and_the_right_one_restores_it(full):
    true = {"x_mm": 25.0, "y_mm": 25.0}
    plain, right = Walked(RigFile(), full), Walked(with_registration(true, true), full)
    assert right.error == pytest.approx(plain.error, rel=0.10)
    assert Walked(with_registration(true, {}), full).error > 1.03 * right.error


def test_a_wrong_rotation_turns_the_robot_off_its_field_and_the_right_one_brings_it_back(full):
    true = {"rotation_deg": 2.5}
    assert abs(Walked(with_registration(true, true), full).offset) < math.radians(0.4)
    wrong = Walked(with_registration(true, {}), full).offset
    assert math.degrees(wrong) == pytest.approx(2.5, abs=0.5)
