"""Rows 15 and 17: the computer dies, freezes, or has no time for the rig. The board has the last word."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from control.simulation.lockstep import Sample
from tests.faults.conftest import SeparateBoard, separate_board
from tests.faults.invariants import (
    Electrics,
    Trace,
    check_limits,
    check_stays_zero,
    check_zero,
    is_driven,
    zero_at,
)
from tests.processes import Server, poll, served

pytestmark = pytest.mark.exclusive

ON_ITS_WAY = 5
"""Milliseconds for a command that was on the line when the computer died."""
AT_ONCE = 60
"""Milliseconds of the board from the signal to zero, the process's own waking up included."""


@dataclass(frozen=True, slots=True)
class Lab:
    """A server and its board, each a process."""

    server: Server
    board: SeparateBoard


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Lab]:
    """For tests that leave the server alive."""
    folder = tmp_path_factory.mktemp("lab")
    with (
        separate_board() as board,
        served(folder / "data", "--rig", str(board.rig_file(folder))) as server,
    ):
        yield Lab(server, board)


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
    lab: Lab, electrics: Electrics, full: bool
) -> None:
    """When the computer freezes, the board switches the coils off within 200 milliseconds; when the computer
    comes back, nothing moves until you say so."""
    for _ in range(10 if full else 2):
        walk(lab.server, lab.board)
        os.kill(lab.server.process.pid, signal.SIGSTOP)
        died = lab.board.milliseconds
        samples = lab.board.samples_for(0.5)
        os.kill(lab.server.process.pid, signal.SIGCONT)
        state = lab.server.until(lambda state: state["rig"] != "running")
        assert state["rig"] in ("held", "disarmed", "fault")
        samples += lab.board.samples_for(0.5)
        assert expect_zero_by_itself(samples, electrics, died) <= electrics.dead_man


def test_a_starved_computer_keeps_within_limits_and_the_coils_off_while_it_is_away(
    lab: Lab, electrics: Electrics
) -> None:
    """When other programs leave the computer hardly any time, the robot may stop, but no coil ever carries more
    than it may, and none is on for more than 200 milliseconds without a fresh command."""
    walk(lab.server, lab.board)
    lab.board.monitor.take()
    samples: list[Sample] = []
    for _ in range(6):
        os.kill(lab.server.process.pid, signal.SIGSTOP)
        samples += lab.board.samples_for(0.3)
        os.kill(lab.server.process.pid, signal.SIGCONT)
        samples += lab.board.samples_for(0.03)
    assert lab.server.until(lambda state: state["rig"] != "running")["reason"]
    check_limits(samples, electrics)
    zero = zero_at(samples, samples[0].milliseconds)
    assert zero - samples[0].milliseconds <= electrics.dead_man + ON_ITS_WAY
    check_stays_zero(Trace(samples), zero)


def test_an_emergency_stop_by_signal_latches_and_the_server_lives_on(lab: Lab, electrics: Electrics) -> None:
    """`kill -USR1` is an emergency stop for scripts and hardware buttons: the coils are off at once, and stay off
    until somebody resets and arms."""
    walk(lab.server, lab.board)
    before = lab.board.milliseconds
    lab.server.process.send_signal(signal.SIGUSR1)
    state = lab.server.until(lambda state: state["rig"] == "fault")
    assert state["faults"][0]["code"] == "estop"
    trace = Trace(lab.board.samples_for(0.6))
    zero = check_zero(trace, electrics, before)
    assert zero - before <= AT_ONCE
    check_stays_zero(trace, zero)
    assert lab.server.get("/health")["status"] == "ok"
    assert lab.server.post("/reset")["rig"] == "disarmed"
    assert not is_driven(lab.board.samples_for(0.3)[-1])
