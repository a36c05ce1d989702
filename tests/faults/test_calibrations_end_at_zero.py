"""However a calibration ends, its coils end at zero, and because the program said so: a real port, a real process."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
import pytest

from control.simulation.lockstep import Sample
from tests.faults.conftest import SeparateBoard
from tests.faults.invariants import is_driven
from tests.processes import poll

pytestmark = pytest.mark.exclusive

GONE_WITHIN = 5.0
"""Seconds that a command may take to end."""
DEAD_MAN = 200


@dataclass(slots=True)
class AtThePrompt:
    """`pivotrig calibrate` of a rig that is not simulated, with a coil under current and a question asked."""

    process: subprocess.Popen[str]
    board: SeparateBoard
    said: str

    def ended(self) -> int:
        """Its exit status, once it has ended in time."""
        return self.process.wait(GONE_WITHIN)

    def rest(self) -> list[Sample]:
        """What the board does for a while after the command has ended."""
        self.board.monitor.take()
        return self.board.samples_for(0.3)


@pytest.fixture
def rig(board: SeparateBoard, tmp_path: Path) -> Path:
    """A real rig, as far as the program can tell: the camera is a video, the port a terminal."""
    video = tmp_path / "plate.avi"
    writer = cv2.VideoWriter(str(video), cv2.VideoWriter.fourcc(*"MJPG"), 30.0, (64, 64))
    for _ in range(60):
        writer.write(np.full((64, 64, 3), 120, np.uint8))
    writer.release()
    rig = tmp_path / "rig.toml"
    rig.write_text(
        f'[camera]\nuri = "file://{video}"\nsize_px = [64, 64]\nrate_Hz = 30.0\n[link]\nport = "{board.port}"\n'
    )
    return rig


@contextmanager
def calibrating(rig: Path, *arguments: str) -> Iterator[subprocess.Popen[str]]:
    command = [sys.executable, "-m", "server", "calibrate", *arguments, "--coil", "z", "--rig", str(rig)]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=pipe, text=True) as process:
        try:
            yield process
        finally:
            process.send_signal(signal.SIGCONT)
            process.kill()


@contextmanager
def at_the_prompt(rig: Path, board: SeparateBoard) -> Iterator[AtThePrompt]:
    with calibrating(rig, "coils", "--measure", "--yes") as process:
        assert process.stderr is not None
        said = ""
        while "field along z" not in said:
            letter = process.stderr.read(1)
            assert letter, f"the command ended before it asked: {said}"
            said += letter
        assert is_driven(board.samples_for(0.05)[-1])
        yield AtThePrompt(process, board, said)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_at_the_prompt_stops_the_coils_before_the_command_ends(
    rig: Path, board: SeparateBoard, number: signal.Signals
) -> None:
    """Ctrl-C, `kill` and a closed terminal switch the coils off at once, not only by the board's dead-man."""
    with at_the_prompt(rig, board) as prompt:
        prompt.process.send_signal(number)
        assert prompt.ended() != 0
        assert not any(map(is_driven, prompt.rest()))
        assert board.monitor.state()["state"] == "stopped"


def test_an_emergency_stop_at_the_prompt_ends_the_calibration(rig: Path, board: SeparateBoard) -> None:
    """`kill -USR1` switches the coils off, and the calibration does not go on with the next one."""
    with at_the_prompt(rig, board) as prompt:
        prompt.process.send_signal(signal.SIGUSR1)
        assert prompt.ended() == 3
        assert "emergency stop" in prompt.process.stderr.read()  # type: ignore[union-attr]
        assert not any(map(is_driven, prompt.rest()))
        assert board.monitor.state()["state"] == "stopped"


def test_an_input_that_ends_leaves_no_coil_under_current(rig: Path, board: SeparateBoard) -> None:
    """When whatever answers the questions goes away, the coils are switched off."""
    with at_the_prompt(rig, board) as prompt:
        assert prompt.process.stdin is not None
        prompt.process.stdin.close()
        assert prompt.ended() == 1
        assert not any(map(is_driven, prompt.rest()))
        assert board.monitor.state()["state"] == "stopped"


def test_a_calibration_that_is_put_to_sleep_does_not_wake_up_with_current(
    rig: Path, board: SeparateBoard
) -> None:
    """Ctrl-Z leaves the coils to the board's dead-man; `fg` ends the calibration instead of going on."""
    with at_the_prompt(rig, board) as prompt:
        prompt.process.send_signal(signal.SIGSTOP)
        asleep = board.samples_for(1.5)
        assert not any(map(is_driven, asleep[2 * DEAD_MAN :]))
        prompt.process.send_signal(signal.SIGCONT)
        awake = board.samples_for(0.5)
        assert not any(map(is_driven, awake))
        assert prompt.ended() == 3


def test_consent_and_readings_may_come_through_one_pipe(rig: Path, board: SeparateBoard) -> None:
    """A script that agrees and types readings is heard to the end, and the coils are off afterwards."""
    with calibrating(rig, "coils", "--measure", "--json") as process:
        said, complaints = process.communicate("y\n1.23\n-1.23\n-2.46\n2.46\n", timeout=60.0)
    assert process.returncode == 0, complaints
    assert '"readings": 4' in said
    assert "sensed" in complaints[: complaints.index("field along z")], (
        "the current is shown before the question"
    )
    poll(lambda: board.monitor.state()["state"], lambda state: state == "stopped")
    time.sleep(0.05)
    assert not is_driven(board.newest)
