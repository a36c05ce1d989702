"""`pivotrig doctor`: what it finds on rigs that are well and on rigs that are not, and that it moves nothing."""

import json
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
import serial
from typer.testing import CliRunner

from control.simulation.lockstep import RemoteBoard
from server.cli import app
from tests.processes import started


@dataclass(frozen=True, slots=True)
class Examination:
    """What the doctor said. status: of the exit."""

    status: int
    checks: dict[str, dict[str, str]]
    problems: int

    def __getitem__(self, name: str) -> dict[str, str]:
        return self.checks[name]


def examined(*arguments: str) -> Examination:
    answer = CliRunner().invoke(app, ["doctor", "--json", *arguments])
    said: dict[str, Any] = json.loads(answer.stdout)
    checks = {check["name"]: check for check in said["checks"]}
    assert all(check["advice"] for check in checks.values() if check["level"] in ("warning", "problem"))
    assert said["problems"] == sum(check["level"] == "problem" for check in said["checks"])
    assert answer.exit_code == (1 if said["problems"] else 0)
    return Examination(answer.exit_code, checks, said["problems"])


@pytest.fixture
def rig_file(tmp_path: Path) -> Path:
    return tmp_path / "rig.toml"


def test_the_paper_s_simulated_rig_is_well() -> None:
    found = examined()
    assert found.problems == 0
    for name in ("python", "packages", "environment", "clock", "scheduling", "data folder", "real time", "coils",
                 "field", "supply", "coil heat", "board settings", "camera", "picture", "handshake", "board state",
                 "supply voltage", "current sense"):  # fmt: skip
        assert found[name]["finding"], name
    assert "640x480 px, 60.0 frames/s" in found["camera"]["finding"]
    assert "boot id" in found["handshake"]["finding"]
    assert found["supply voltage"]["level"] == "ok"


def test_as_a_process_it_prints_one_line_a_check(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "server", "doctor", "--data", str(tmp_path)]
    answer = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert answer.returncode == 0, answer.stderr
    lines = answer.stdout.splitlines()
    assert all(line.split()[0] in ("ok", "info", "warning", "problem") for line in lines)
    assert len(lines) >= 15
    assert list(tmp_path.iterdir()) == []


def test_a_rig_file_that_cannot_be_used_is_quoted_with_the_way_back(rig_file: Path) -> None:
    rig_file.write_text("[robot]\nlength_mm = -1\n")
    rig_file.with_name("rig.toml.previous").write_text("[robot]\nlength_mm = 9.0\n")
    check = examined("--rig", str(rig_file))["rig file"]
    assert check["level"] == "problem"
    assert "robot.length_mm" in check["finding"]
    assert "(line 2)" in check["finding"]
    assert "rig.toml.previous over it" in check["advice"]


def test_a_newer_rig_file_asks_for_a_newer_program(rig_file: Path) -> None:
    rig_file.write_text("version = 3\n")
    assert "needs a newer pivotrig" in examined("--rig", str(rig_file))["rig file"]["finding"]


def test_a_rig_file_that_is_not_there_is_named(rig_file: Path) -> None:
    assert "there is no rig file" in examined("--rig", str(rig_file))["rig file"]["finding"]


def test_a_data_folder_that_takes_no_file_is_a_problem(tmp_path: Path) -> None:
    in_the_way = tmp_path / "file"
    in_the_way.write_text("")
    assert examined("--data", str(in_the_way))["data folder"]["level"] == "problem"


@pytest.mark.parametrize(
    ("text", "name", "level", "words"),
    [
        ("[coils]\nsupply_V = 12.0\n", "supply", "warning", "it will saturate"),
        ("[limits]\ncurrent_A = [5.0, 5.0, 5.0]\n", "field", "warning", "the usual 10 mT will saturate"),
        ("[limits]\ncontinuous_A = [4.0, 4.0, 4.0]\n", "coil heat", "warning", "holds at 100 %"),
        (
            "[limits]\nheat_time_constant_s = [5, 2100, 1300]\n",
            "coil heat",
            "warning",
            "heat_time_constant_s",
        ),
        ("[limits]\nworkspace_mm = 900\n", "coils", "problem", "[coils]"),
        ("[camera]\nrate_Hz = 500.0\n", "camera", "ok", ""),
    ],
)
def test_values_that_do_not_suit_each_other_are_noticed(
    rig_file: Path, text: str, name: str, level: str, words: str
) -> None:
    rig_file.write_text(text)
    check = examined("--rig", str(rig_file))[name]
    assert check["level"] == level, check
    assert words in check["advice"]


def test_devices_that_are_not_there_are_each_named(rig_file: Path) -> None:
    rig_file.write_text('[camera]\nuri = "v4l:///dev/nothing0"\n[link]\nport = "/dev/nothing1"\n')
    found = examined("--rig", str(rig_file))
    for name in ("permission /dev/nothing0", "permission /dev/nothing1", "board", "camera"):
        assert found[name]["level"] == "problem"
    assert "/dev/nothing1" in found["board"]["finding"]
    assert "camera /dev/nothing0 is not plugged in" in found["camera"]["finding"]
    assert found["cameras"]["level"] == "info"


def test_a_board_that_is_to_be_found_by_itself_and_is_not_there_is_a_problem(rig_file: Path) -> None:
    rig_file.write_text('[camera]\nuri = "v4l:///dev/nothing0"\n[link]\nport = "auto"\n')
    assert "no board is connected" in examined("--rig", str(rig_file))["board"]["finding"]


@dataclass(slots=True)
class RealEnough:
    """A board behind a real serial port, and a camera that is a video file: a rig that is not simulated."""

    port: str
    board: RemoteBoard
    rig_file: Path
    arguments: list[str] = field(default_factory=list)

    def examined(self) -> Examination:
        return examined("--rig", str(self.rig_file), *self.arguments)


@pytest.fixture
def real(tmp_path: Path, rig_file: Path) -> Iterator[RealEnough]:
    video = tmp_path / "robot.avi"
    write_video(video, rate=30.0, shade=120)
    with started("control.simulation.board_process", "--control-port", "0", "--linger", "60") as (_, line):
        port, control = (part.partition("=")[2] for part in line.split()[1:])
        rig_file.write_text(
            f'[camera]\nuri = "file://{video}"\nsize_px = [64, 64]\nrate_Hz = 30.0\n[link]\nport = "{port}"\n'
        )
        board = RemoteBoard(control, realtime=True)
        yield RealEnough(port, board, rig_file)
        board.close()


def write_video(path: Path, rate: float, shade: int) -> None:
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"MJPG"), rate, (64, 64))
    for _ in range(120):
        writer.write(np.full((64, 64, 3), shade, np.uint8))
    writer.release()


def test_a_rig_that_is_well_is_told_so_and_no_current_ever_flows(real: RealEnough) -> None:
    real.board.take()
    found = real.examined()
    assert found.problems == 0, found
    assert "firmware" in found["board"]["finding"]
    assert "last reset" in found["board"]["finding"]
    assert "round trip" in found["board"]["finding"]
    assert found["handshake"]["level"] == "ok"
    assert "24.0 V" in found["supply voltage"]["finding"]
    samples = real.board.take()
    assert len(samples) > 200
    assert not any(any(sample.duty) or any(sample.currents) for sample in samples)


def test_a_supply_that_is_off_is_a_problem_and_one_that_is_odd_a_warning(real: RealEnough) -> None:
    real.board.set_condition("supply_mV", 0)
    assert "switch the coils' supply on" in real.examined()["supply voltage"]["advice"]
    real.board.set_condition("supply_mV", 21_000)
    found = real.examined()
    assert found["supply voltage"]["level"] == "warning"
    assert ", 24 V in the rig file" in found["supply voltage"]["finding"]


def test_a_port_that_somebody_else_has_open_is_busy(real: RealEnough) -> None:
    with serial.Serial(real.port, exclusive=True):
        check = real.examined()["board"]
    assert check["level"] == "problem"
    assert "close the other program" in check["advice"]


def test_a_port_on_which_nobody_answers_is_a_problem(real: RealEnough) -> None:
    real.rig_file.write_text(real.rig_file.read_text().replace(real.port, "/dev/null"))
    assert real.examined()["board"]["level"] == "problem"
    real.arguments = ["--port", real.port]
    assert real.examined()["board"]["level"] == "ok"


def test_a_camera_that_gives_less_than_was_asked_or_nothing_to_see_is_noticed(
    real: RealEnough, tmp_path: Path
) -> None:
    text = real.rig_file.read_text()
    real.rig_file.write_text(text.replace("rate_Hz = 30.0", "rate_Hz = 60.0"))
    assert "60 were asked" in real.examined()["camera"]["finding"]
    real.rig_file.write_text(text.replace("[64, 64]", "[640, 480]"))
    assert "64x64 px" in real.examined()["camera"]["finding"]
    write_video(tmp_path / "robot.avi", rate=30.0, shade=1)
    real.rig_file.write_text(text)
    assert real.examined()["picture"]["level"] == "warning"


def test_a_damaged_recording_is_no_question_of_settings(real: RealEnough, tmp_path: Path) -> None:
    for number in range(60):
        cv2.imwrite(str(tmp_path / f"{number}.png"), np.full((64, 64, 3), 60, np.uint8))
    (tmp_path / "5.png").write_text("no picture")
    text = real.rig_file.read_text()
    real.rig_file.write_text(text.replace(f"file://{tmp_path}/robot.avi", f"folder://{tmp_path}"))
    found = real.examined()
    assert "1 of its pictures could not be used" in found["camera trouble"]["finding"]
    assert "camera settings" not in found.checks


def test_the_traffic_log_of_a_rig_that_runs_is_left_alone(
    rig_file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_DATA_HOME", str(rig_file.parent / "home"))
    rig_file.write_text("[link]\ntraffic_log = true\n")
    assert examined("--rig", str(rig_file), "--data", str(rig_file.parent / "data")).problems == 0
    assert list(rig_file.parent.rglob("*traffic*")) == []


def test_a_path_that_cannot_be_looked_at_is_a_problem_and_no_traceback(tmp_path: Path) -> None:
    assert "File name too long" in examined("--rig", str(tmp_path / ("a" * 300)))["rig file"]["finding"]


def test_a_coil_that_the_board_cannot_regulate_is_named_in_its_own_units(rig_file: Path) -> None:
    rig_file.write_text(
        "[coils.z]\ndiameter_mm = 225\nseparation_mm = 110\nturns = 154\nresistance_ohm = 1.5\ninductance_mH = 1\n"
    )
    found = examined("--rig", str(rig_file))["board settings"]
    assert found["level"] == "problem"
    assert "inductance of coil 3 of 1 mH; the board takes 3 to 160 mH" in found["finding"]
