"""Rows 15 and 17: the computer dies, freezes, or has no time for the rig. The board has the last word."""

from __future__ import annotations

import os
import signal
import time
from pathlib import Path

import pytest

from control.simulation.lockstep import Sample
from tests.faults.conftest import SeparateBoard
from tests.faults.invariants import Electrics, Trace, check_limits, check_stays_zero, check_zero, is_driven
from tests.processes import Server, poll, served

pytestmark = pytest.mark.exclusive

ON_ITS_WAY = 5
"""Milliseconds for a command that was on the line when the computer died."""


def walk(server: Server, board: SeparateBoard) -> None:
    server.start_walking()
    poll(lambda: board.samples_for(0.1)[-1], is_driven)


def expect_zero_by_itself(samples: list[Sample], electrics: Electrics, died: int) -> int:
    """The invariants of a board that is alone; how long its drive lasted, ms."""
    trace = Trace(samples)
    check_limits(samples, electrics)
    zero = check_zero(trace, electrics, died + ON_ITS_WAY)
    check_stays_zero(trace, zero)
    return zero - died


def test_a_computer_that_crashes_leaves_the_coils_off_within_200_ms(
    board: SeparateBoard, tmp_path: Path, electrics: Electrics, full: bool
) -> None:
    """When the computer or the program dies in the middle of a run, the board switches its coils off within 200
    milliseconds; the next start finds the rig disarmed."""
    rig_file = board.rig_file(tmp_path)
    for _ in range(10 if full else 1):
        with served(tmp_path / "data", "--rig", str(rig_file)) as server:
            walk(server, board)
            server.process.kill()
            died = board.milliseconds
            lasted = expect_zero_by_itself(board.samples_for(0.6), electrics, died)
            assert lasted <= electrics.dead_man
    with served(tmp_path / "data", "--rig", str(rig_file)) as server:
        assert server.get("/state")["rig"] == "disarmed"
        assert not any(is_driven(sample) for sample in board.samples_for(0.5))


def test_a_computer_that_freezes_finds_its_rig_held_or_disarmed_when_it_comes_back(
    board: SeparateBoard, tmp_path: Path, electrics: Electrics, full: bool
) -> None:
    """When the computer freezes, the board switches the coils off within 200 milliseconds; when the computer
    comes back, nothing moves until you say so."""
    with served(tmp_path / "data", "--rig", str(board.rig_file(tmp_path))) as server:
        for _ in range(10 if full else 3):
            walk(server, board)
            os.kill(server.process.pid, signal.SIGSTOP)
            died = board.milliseconds
            samples = board.samples_for(0.5)
            os.kill(server.process.pid, signal.SIGCONT)
            state = server.until(lambda state: state["rig"] != "running")
            assert state["rig"] in ("held", "disarmed", "fault")
            samples += board.samples_for(0.5)
            assert expect_zero_by_itself(samples, electrics, died) <= electrics.dead_man
            server.post("/disarm") if state["rig"] != "fault" else server.post("/reset")


def test_a_starved_computer_keeps_within_limits_and_the_coils_off_while_it_is_away(
    board: SeparateBoard, tmp_path: Path, electrics: Electrics
) -> None:
    """When other programs leave the computer hardly any time, the robot may stop, but no coil ever carries more
    than it may, and none is on for more than 200 milliseconds without a fresh command."""
    with served(tmp_path / "data", "--rig", str(board.rig_file(tmp_path))) as server:
        walk(server, board)
        samples: list[Sample] = []
        for _ in range(6):
            os.kill(server.process.pid, signal.SIGSTOP)
            samples += board.samples_for(0.3)
            os.kill(server.process.pid, signal.SIGCONT)
            samples += board.samples_for(0.03)
        assert server.until(lambda state: state["rig"] != "running")["reason"]
    check_limits(samples, electrics)
    assert longest_drive_after_the_last_command(samples) <= electrics.dead_man + ON_ITS_WAY


def longest_drive_after_the_last_command(samples: list[Sample]) -> int:
    """The board was alone for 300 ms at first: how long it drove, ms."""
    start = samples[0].milliseconds
    return next(s.milliseconds for s in samples if not is_driven(s)) - start


def test_an_emergency_stop_by_signal_latches_and_the_server_lives_on(
    board: SeparateBoard, tmp_path: Path, electrics: Electrics
) -> None:
    """`kill -USR1` is an emergency stop for scripts and hardware buttons: the coils are off at once, and stay off
    until somebody resets and arms."""
    with served(tmp_path / "data", "--rig", str(board.rig_file(tmp_path))) as server:
        walk(server, board)
        before = board.milliseconds
        server.process.send_signal(signal.SIGUSR1)
        state = server.until(lambda state: state["rig"] == "fault")
        assert state["faults"][0]["code"] == "estop"
        samples = board.samples_for(0.6)
        zero = check_zero(Trace(samples), electrics, before)
        assert zero - before <= 60, "milliseconds of the board's, the signal's way included"
        check_stays_zero(Trace(samples), zero)
        assert server.get("/health")["status"] == "ok"
        server.post("/reset")
        time.sleep(0.2)
        assert server.get("/state")["rig"] == "disarmed"
        assert not is_driven(board.samples_for(0.2)[-1])
