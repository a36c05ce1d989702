"""The lock-step port of every simulated board: the same words, whether the twin or the emulator is behind it."""

from __future__ import annotations

from contextlib import closing

import pytest
from board_contact import SteppedContact

from control.simulation.lockstep import RemoteBoard


def test_the_control_port_tells_the_same_of_every_simulated_board(board: SteppedContact) -> None:
    keys = {"time_ms", "mode", "state", "firmware", "boot_id", "duty", "drive_is_zero", "currents_mA"}
    board.driving(milliseconds=100)
    told = board.board.state()
    assert set(told) == keys
    assert [told["mode"], told["state"], told["boot_id"]] == ["step", "driving", board.boot_id]
    assert told["time_ms"] == board.now
    assert told["duty"] == list(board.duty)


NONSENSE = (
    *(
        "step 0",
        "step -1",
        "step 1001",
        "step x",
        "step",
        "",
        "fly",
        "step 1 2",
        "run on",
        "reset now",
        "set",
    ),
    *("set supply_mV", "set supply_mV x", "set supply_mV 65001", "set supply_mV 1 24000", "set supply_mV -1"),
    *("set driver_fault 1", "set driver_fault 0 1", "set driver_fault 4 1", "set driver_fault 1 2"),
    *("set fire 1", "set open_coil 1 1 1", "set supply_mV 9999999999", "\x7f" * 200, "step 1\tx"),
)


def test_nonsense_on_the_control_port_is_an_error_and_changes_nothing(board: SteppedContact) -> None:
    before = board.board.state()
    for request in NONSENSE:
        with pytest.raises(ConnectionError, match="error:"):
            board.board.ask(request)
    assert board.board.state() == before


def test_two_clients_have_each_their_own_samples(board: SteppedContact) -> None:
    with closing(RemoteBoard(board.board.url, realtime=False)) as monitor:
        monitor.state()
        board.run(40)
        assert [s.milliseconds for s in monitor.take()] == [s.milliseconds for s in board.samples[-40:]]
        board.run(2400)
        late = monitor.take()
        assert [late[0].milliseconds, late[-1].milliseconds] == [board.now - 1999, board.now]
