"""The lock-step port: text in, board time and currents out; one server, several clients."""

from __future__ import annotations

import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace

import pytest
from board_bench import ARM, CALM, CONFIGURE, Bench

from control.link import wire
from control.link.messages import BoardCode, Hello
from control.simulation.lockstep import RemoteBoard
from control.simulation.lockstep_server import LockstepServer


class StoppedClock:
    """Moves only when it is told to, so that a free-running board stands still too."""

    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


class Served:
    """A board behind a port, served by a thread of the test."""

    def __init__(self) -> None:
        self.bench = Bench()
        self.clock = StoppedClock()
        self.server = LockstepServer(self.bench.board, 0, self.clock, lambda: None)
        self.url = self.server.url
        self._is_over = False
        self._thread = threading.Thread(target=self._serve)
        self._thread.start()

    def _serve(self) -> None:
        while not self._is_over:
            self.server.serve(0.005)

    def end(self) -> None:
        self._is_over = True
        self._thread.join()
        self.server.close()


@pytest.fixture
def served() -> Iterator[Served]:
    board = Served()
    yield board
    board.end()


@contextmanager
def remote(url: str, realtime: bool = False) -> Iterator[RemoteBoard]:
    board = RemoteBoard(url, realtime)
    try:
        yield board
    finally:
        board.close()


def ask(url: str, *requests: bytes) -> list[bytes]:
    """One raw client: all answers up to the end of the connection's first silence."""
    host, port = url.removeprefix("tcp://").split(":")
    with socket.create_connection((host, int(port)), timeout=5) as connection:
        connection.sendall(b"".join(requests))
        connection.shutdown(socket.SHUT_WR)
        answer = b""
        while data := connection.recv(65536):
            answer += data
    return answer.splitlines()


def arm(bench: Bench) -> None:
    arming = replace(CALM, flags=ARM)
    for number, message in enumerate((Hello(), CONFIGURE, arming), start=1):
        bench.board.write(wire.encode(message, number, 7))


def test_a_stepped_board_gives_the_currents_of_the_board_in_process(served: Served) -> None:
    twin = Bench()
    arm(twin)
    arm(served.bench)
    with remote(served.url) as board:
        ours = [current for _ in range(10) for current in board.advance(13)]
    theirs = twin.board.advance(130)
    for mine, other in zip(ours, theirs, strict=True):
        assert mine == pytest.approx(other, abs=1e-6)
    assert served.bench.board.state == BoardCode.DRIVING


def test_a_long_advance_is_asked_for_in_pieces(served: Served) -> None:
    with remote(served.url) as board:
        assert len(board.advance(2500)) == 2500
        assert board.advance(0) == []
    assert served.bench.board.milliseconds == 2500


def test_a_stepped_board_stands_still_between_steps(served: Served) -> None:
    with remote(served.url) as board:
        board.advance(5)
        served.clock.now += 10.0
        assert board.state()["mode"] == "step"
        assert board.state()["time_ms"] == 5


def test_a_board_runs_on_freely_when_its_stepper_is_gone_so_that_its_dead_man_acts(served: Served) -> None:
    arm(served.bench)
    with remote(served.url) as monitor:
        with remote(served.url) as stepper:
            stepper.advance(20)
            assert monitor.state()["drive_is_zero"] is False
        while monitor.state()["mode"] != "run":
            pass
        served.clock.now += 0.25
        while monitor.state()["time_ms"] != 270:
            pass
        assert monitor.state()["drive_is_zero"] is True
        assert monitor.state()["state"] == "expired"


def test_a_free_running_board_keeps_real_time(served: Served) -> None:
    with remote(served.url, realtime=True) as board:
        served.clock.now += 0.0305
        while board.state()["time_ms"] != 30:
            pass
        assert len(board.advance(16)) == 16
        assert len(board.advance(16)) == 16


def test_each_client_takes_its_own_samples(served: Served) -> None:
    with remote(served.url) as world, remote(served.url) as monitor:
        monitor.state()
        world.advance(40)
        samples = monitor.take()
    assert [sample.milliseconds for sample in samples] == list(range(1, 41))


def test_samples_that_nobody_takes_are_bounded(served: Served) -> None:
    with remote(served.url) as world, remote(served.url) as monitor:
        monitor.state()
        world.advance(2400)
        samples = monitor.take()
    assert [samples[0].milliseconds, samples[-1].milliseconds] == [401, 2400]


def test_nonsense_is_answered_and_changes_nothing(served: Served) -> None:
    nonsense = b"step 0\nstep -1\nstep 1001\nstep x\nstep\n\nfly\nstep 1 2\n\xff\xfe\n"
    answers = ask(served.url, nonsense, b"state\n")
    assert len(answers) == 10
    assert all(answer.startswith(b"error:") for answer in answers[:-1])
    assert b'"time_ms": 0' in answers[-1]


def test_conditions_are_set_over_the_port(served: Served) -> None:
    arm(served.bench)
    with remote(served.url) as board:
        board.advance(200)
        board.set_condition("open_coil", 1, 1)
        board.set_condition("supply_mV", 20000)
        assert board.advance(1)[0][0] == 0.0
        board.set_condition("driver_fault", 1, 3)
        board.advance(2)
        assert board.state()["state"] == "fault"
    assert served.bench.board.supply == 20.0


def test_a_reset_over_the_port_boots_the_board_anew(served: Served) -> None:
    arm(served.bench)
    with remote(served.url) as board:
        board.advance(200)
        before = board.state()
        board.reset()
        board.advance(1)
        after = board.state()
    assert [before["firmware"], before["boot_id"], before["state"]] == ["twin", 7, "driving"]
    assert [after["firmware"], after["boot_id"], after["state"]] == ["twin", 8, "booted"]
    assert after["drive_is_zero"] is True


def test_conditions_that_there_are_not_are_answered_and_change_nothing(served: Served) -> None:
    nonsense = (
        b"set\nset supply_mV\nset supply_mV x\nset supply_mV 65001\nset supply_mV 1 24000\nset supply_mV -1\n"
        b"set driver_fault 1\nset driver_fault 0 1\nset driver_fault 4 1\nset driver_fault 1 2\n"
        b"set fire 1 1\nset open_coil 1 1 1\nreset now\nset supply_mV 9999999999\n"
    )
    answers = ask(served.url, nonsense, b"state\n")
    assert len(answers) == 15
    assert all(answer.startswith(b"error:") for answer in answers[:-1])
    assert served.bench.board.supply == 24.0
    assert served.bench.board.boot_id == 7


def test_an_endless_request_is_cut_off(served: Served) -> None:
    host, port = served.url.removeprefix("tcp://").split(":")
    with socket.create_connection((host, int(port)), timeout=5) as connection:
        connection.sendall(b"x" * 1000)
        with suppress(ConnectionResetError):  # cut off with bytes unread
            assert connection.recv(10) == b""
    assert ask(served.url, b"step 1\n")[-1] == b"done"


def test_a_board_that_goes_away_is_an_error_that_says_so(served: Served) -> None:
    with remote(served.url) as board:
        board.advance(1)
        served.end()
        with pytest.raises((ConnectionError, BrokenPipeError)):
            board.advance(1)


@pytest.mark.parametrize("url", ["", "tcp://", "http://127.0.0.1:80", "127.0.0.1:5000"])
def test_an_address_that_is_none_is_refused(url: str) -> None:
    with pytest.raises(ValueError, match="tcp://"):
        RemoteBoard(url, realtime=False)
