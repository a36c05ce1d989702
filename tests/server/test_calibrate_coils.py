"""`pivotrig calibrate coils`, `windings` and `sense` on the simulated rig: the board's bytes, the world's field."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from control.axes import AXES
from control.calibration.bench import Bench, BenchSettings
from control.calibration.windings import check_windings
from control.link.messages import BoardCode
from control.safety import Refused
from control.simulation.board import TwinBoard
from server.assembly import Machine, build_machine
from server.cli import app
from server.commands.calibrate_windings import steady_coils
from server.commands.held_coil import Held, HeldCoil
from server.rig_file import load_rig_file
from server.settings import RigFile
from server.settings_in_si import coil_set

TRUE_GAINS = [1.12, 0.93, 1.05]


def rig_at(folder: Path, text: str) -> str:
    path = folder / "rig.toml"
    path.write_text(text)
    return str(path)


def calibrate(*arguments: str, input: str | None = None):
    return CliRunner().invoke(app, ["calibrate", *arguments], input=input)


def said(answer) -> str:
    """What people were told, on one line: a terminal of 80 columns breaks it anywhere."""
    return " ".join(answer.stderr.split())


def test_the_simulated_magnetometer_finds_the_true_gains_and_saves_them(tmp_path):
    rig = rig_at(tmp_path, f"# kept\n[simulation]\nfield_gain = {TRUE_GAINS}\n")
    answer = calibrate("coils", "--simulate-readings", "--current", "4", "--rig", rig, "--save", "--json")
    assert answer.exit_code == 0, answer.stderr
    found = json.loads(answer.stdout)["pairs"]
    for axis, true in zip(AXES, TRUE_GAINS, strict=True):
        assert found[axis]["field_gain"] == pytest.approx(true, abs=4 * found[axis]["standard_error"])
    saved = load_rig_file(Path(rig)).coils
    assert saved.x.field_gain == pytest.approx(TRUE_GAINS[0], abs=0.03)
    assert saved.field_source.startswith("measured 20")
    assert "# kept" in Path(rig).read_text()


def test_gains_that_are_saved_bring_the_field_to_what_is_commanded():
    right = {axis: {"field_gain": gain} for axis, gain in zip(AXES, TRUE_GAINS, strict=True)}
    trusting = RigFile().with_simulation(field_gain=TRUE_GAINS)
    calibrated = RigFile.model_validate(trusting.model_dump(mode="json") | {"coils": _deep(trusting, right)})
    true = build_machine(trusting, realtime=False).world
    assert true is not None
    for settings, off in ((trusting, 0.12), (calibrated, 0.0)):
        allocation = coil_set(settings).local_allocation(0.01, 0.02)
        currents = tuple(row[0] * 0.01 for row in allocation)
        made = true.coils.local_field(0.01, 0.02, (currents[0], currents[1], currents[2]))
        assert made[0] / 0.01 - 1.0 == pytest.approx(off, abs=1e-3)
    true.close()


def _deep(settings: RigFile, changes: dict) -> dict:
    coils = settings.model_dump(mode="json")["coils"]
    return {**coils, **{axis: {**coils[axis], **change} for axis, change in changes.items()}}


def test_swapped_leads_are_named_by_the_magnetometer(tmp_path):
    rig = rig_at(tmp_path, '[simulation]\nwiring = ["x", "-y", "z"]\n')
    answer = calibrate("coils", "--simulate-readings", "--rig", rig)
    assert answer.exit_code == 1
    assert "the y coils' field has the wrong sign" in said(answer)


@pytest.mark.exclusive
def test_a_person_is_asked_for_each_reading_and_may_type_them(tmp_path):
    rig = rig_at(tmp_path, "[limits]\n")
    per_ampere = coil_set(RigFile()).centre[2][2] * 1e3
    typed = "about two\n" + "\n".join(
        f"{1.1 * per_ampere * current:.4f}" for current in (1.0, -1.0, -2.0, 2.0)
    )
    answer = calibrate("coils", "--measure", "--coil", "z", "--rig", rig, "--json", input=typed + "\n")
    assert answer.exit_code == 0, answer.stderr
    assert "field along z, mT" in said(answer)
    assert "'about two' is no number" in said(answer)
    result = json.loads(answer.stdout)
    assert result["pairs"]["z"]["field_gain"] == pytest.approx(1.1, abs=0.015)


def test_readings_may_come_from_a_file(tmp_path):
    per_ampere = coil_set(RigFile()).centre[0][0] * 1e3
    rows = [f"x,{current},0,0,0,x,{0.9 * per_ampere * current + 0.02}" for current in (2, -2, 1, -1)]
    file = tmp_path / "readings.csv"
    file.write_text("coil,current_A,x_mm,y_mm,z_mm,component,field_mT\n" + "\n".join(rows) + "\n")
    rig = rig_at(tmp_path, "")
    answer = calibrate("coils", "--readings", str(file), "--rig", rig, "--json")
    assert answer.exit_code == 0, answer.stderr
    assert json.loads(answer.stdout)["pairs"]["x"]["field_gain"] == pytest.approx(0.9, abs=1e-3)


@pytest.mark.parametrize(
    ("arguments", "status", "complaint"),
    [
        (["coils"], 2, "choose one"),
        (["coils", "--simulate-readings", "--coil", "w"], 2, "there are no coils w"),
        (["coils", "--simulate-readings", "--current", "9"], 3, "its limit is 8 A"),
        (["coils", "--readings", "/nowhere.csv"], 1, "cannot read /nowhere.csv"),
        (["coils", "--simulate-readings", "--point", "nan", "0", "0"], 2, "--point takes three lengths"),
        (["sense", "--simulate-readings", "--current", "1"], 2, "than or equal to 1.2"),
        (["registration", "--x-mm", "nan"], 2, "x_mm: Input should be a finite number"),
        (["registration", "--y-mm", "201"], 2, "y_mm: Input should be less than or equal to 200"),
        (["registration", "--at-centre-mark", "--x-mm", "1"], 2, "choose one"),
        (["coils", "--simulate-readings", "--point", "0", "0", "5000"], 1, "measure the x component near"),
    ],
)
def test_what_cannot_be_measured_is_explained(tmp_path, arguments, status, complaint):
    answer = calibrate(*arguments, "--rig", rig_at(tmp_path, ""))
    assert answer.exit_code == status
    assert complaint in said(answer)


@pytest.mark.parametrize("command", [["windings"], ["coils", "--simulate-readings"], ["polarity"], ["gait"]])
@pytest.mark.parametrize(
    ("text", "status", "complaint"),
    [
        ("[limits]\nworkspace_mm = 600\n", 2, "worst condition number"),
        ('[simulation]\nboard = "tcp://127.0.0.1:1"\n', 3, "the rig cannot be opened"),
    ],
)
def test_a_rig_that_cannot_be_opened_is_explained(tmp_path, command, text, status, complaint):
    answer = calibrate(*command, "--rig", rig_at(tmp_path, text))
    assert answer.exit_code == status, answer.exception
    assert complaint in said(answer)


def test_a_result_that_cannot_be_saved_is_not_lost(tmp_path):
    rig = rig_at(tmp_path, "# as it was\n")
    (tmp_path / "rig.toml.previous" / "in the way").mkdir(parents=True)
    answer = calibrate("windings", "--coil", "x", "--rig", rig, "--save")
    assert answer.exit_code == 1
    assert "cannot be saved" in said(answer)
    assert "[coils.x] resistance_ohm = 2.49" in said(answer)
    assert Path(rig).read_text() == "# as it was\n"
    assert [path.name for path in tmp_path.iterdir() if path.name.startswith(".")] == []


def test_a_file_that_holds_no_readings_is_explained(tmp_path):
    file = tmp_path / "readings.csv"
    file.write_text("coil,amps\nx,1\n")
    answer = calibrate("coils", "--readings", str(file), "--rig", rig_at(tmp_path, ""))
    assert answer.exit_code == 1
    assert "no file of readings" in said(answer)


def test_a_real_rig_is_not_driven_without_consent(tmp_path):
    rig = rig_at(tmp_path, '[camera]\nuri = "v4l://7"\n[link]\nport = "/dev/nowhere"\n')
    answer = calibrate("windings", "--rig", rig, input="n\n")
    assert answer.exit_code == 3
    assert "nothing was driven" in said(answer)
    answer = calibrate("coils", "--simulate-readings", "--rig", rig)
    assert answer.exit_code == 2
    assert "belongs to the simulated rig" in said(answer)


def test_the_windings_of_the_default_rig_are_the_rig_files(tmp_path):
    answer = calibrate("windings", "--rig", rig_at(tmp_path, ""), "--json")
    assert answer.exit_code == 0, answer.stderr
    found = json.loads(answer.stdout)["windings"]
    assert [found[axis]["resistance_ohm"] for axis in AXES] == pytest.approx([2.5, 2.0, 1.5], rel=0.01)


def test_the_ammeter_gives_each_channel_and_direction_its_gain(tmp_path):
    answer = calibrate("sense", "--simulate-readings", "--coil", "y", "--rig", rig_at(tmp_path, ""), "--json")
    assert answer.exit_code == 0, answer.stderr
    gains = json.loads(answer.stdout)["sense"]["y"]["sense_mA_per_count"]
    assert gains == pytest.approx([34.88, 34.88], rel=0.01)


class OnTheBench:
    """The simulated rig as a bench, with its board within reach."""

    def __init__(self, **simulation) -> None:
        self.settings = RigFile().with_simulation(**simulation)
        self.machine: Machine = build_machine(self.settings, realtime=False)
        assert self.machine.world is not None
        self.world = self.machine.world
        board = self.world.board
        assert isinstance(board, TwinBoard)
        self.board = board

    def __enter__(self):
        self.machine.open()
        self.bench = Bench(
            self.machine.camera, self.machine.loop.parts, BenchSettings(0.15, 0.01 / 0.3, 0.015)
        )
        self.bench.wait_until_ready()
        return self

    def __exit__(self, *_):
        self.bench.__exit__()
        self.machine.close()


def winding(on: OnTheBench, axis, current=2.0):
    steady = steady_coils(on.bench, Held(axis, current), on.settings)
    (check,) = check_windings(coil_set(on.settings).pairs, steady)
    return check


@pytest.mark.parametrize(("axis", "index"), [("x", 1), ("z", 3)])
def test_a_winding_that_is_off_by_more_than_15_percent_is_named_with_a_likely_cause(axis, index):
    with OnTheBench() as on:
        due = getattr(on.settings.coils, axis).resistance_ohm
        on.board.set_condition("resistance_mohm", round(due * 1300), index)
        check = winding(on, axis)
    assert check.resistance == pytest.approx(1.3 * due, rel=0.02)
    assert "hot winding" in check.complaint or "are they exchanged" in check.complaint


def test_an_open_lead_stops_the_check_at_zero_and_is_named():
    with OnTheBench() as on:
        on.board.set_condition("open_coil", 1, 2)
        with pytest.raises(Refused, match="coil y"):
            winding(on, "y")
        assert on.board.duty == (0, 0, 0)


def test_one_coil_alone_carries_its_current_and_is_at_zero_afterwards():
    with OnTheBench() as on:
        for index in range(3):
            reports = on.bench.hold_coil(index, -3.0, 0.2)
            assert len(reports) > 8
            for report in reports:
                wanted = [0.0, 0.0, 0.0]
                wanted[index] = -3.0
                assert report.currents == pytest.approx(wanted, abs=0.01)
                assert report.measured_currents == pytest.approx(wanted, abs=0.06)
            assert on.board.duty == (0, 0, 0)


def test_a_current_beyond_its_limit_never_leaves_the_host():
    with OnTheBench() as on:
        with pytest.raises(Refused, match="its limit is 8 A"):
            on.bench.hold_coil(0, 8.01, 0.1)
        assert on.board.drive_is_zero


def interrupted(on: OnTheBench) -> None:
    with HeldCoil(on.bench, Held("x", 2.0)):
        assert abs(on.board.currents[0]) > 1.9
        raise KeyboardInterrupt


def without_supply(on: OnTheBench) -> None:
    with HeldCoil(on.bench, Held("x", 2.0)) as held:
        on.board.supply = 0.0
        on_its_own(held)


def test_an_error_while_a_coil_is_held_leaves_it_at_zero():
    with OnTheBench() as on:
        with pytest.raises(KeyboardInterrupt):
            interrupted(on)
        assert on.board.drive_is_zero


def test_a_supply_that_goes_off_ends_the_hold_and_says_so():
    with OnTheBench() as on:
        with pytest.raises(Refused, match="supply"):
            without_supply(on)
        assert on.board.drive_is_zero


def left_alone(on: OnTheBench) -> None:
    with HeldCoil(on.bench, Held("z", 2.0), patience=1.0) as held:
        assert abs(held.sensed) > 1.9
        on_its_own(held)
        assert on.board.duty == (0, 0, 0)


def test_a_coil_that_nobody_comes_back_to_is_let_go_of():
    with OnTheBench() as on, pytest.raises(Refused, match="no reading came within 1 s"):
        left_alone(on)


class Pulled(Exception):
    """The camera's cable."""


def test_a_camera_that_fails_while_a_coil_is_held_leaves_it_at_zero_at_once():
    def pulled(_: float) -> None:
        raise Pulled

    with OnTheBench() as on:
        step = on.bench.step

        def step_until_driven():
            if abs(on.board.currents[0]) > 1.0:
                on.bench.camera.read = pulled  # type: ignore[method-assign]
            return step()

        on.bench.step = step_until_driven  # type: ignore[method-assign]
        with pytest.raises(Pulled):
            on.bench.hold_coil(0, 2.0, 0.1)
        on.board.advance(3)
        assert on.board.drive_is_zero
        assert on.board.state == BoardCode.STOPPED


def on_its_own(held: HeldCoil) -> None:
    """Wait until the thread that holds the coil has given up."""
    held._thread.join(timeout=20.0)
    assert not held._thread.is_alive()
