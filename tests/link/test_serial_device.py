"""A device is jammed when it takes no bytes, and never because the computer had no time."""

from __future__ import annotations

import os
import pty
import signal
import time
import tty
from collections.abc import Iterator
from types import FrameType

import pytest
from serial.serialutil import SerialTimeoutException

from control.link.line import SerialLine
from control.link.opening import WRITE_TIMEOUT, open_serial


@pytest.fixture
def terminal() -> Iterator[tuple[SerialLine, int]]:
    """A device, and the board's end of its line."""
    board, host = pty.openpty()
    tty.setraw(host)
    device = open_serial(os.ttyname(host), 500_000)
    try:
        yield device, board
    finally:
        device.close()
        os.close(board)
        os.close(host)


def test_what_is_written_arrives_whole(terminal: tuple[SerialLine, int]) -> None:
    device, board = terminal
    assert device.write(b"0123456789") == 10
    assert os.read(board, 100) == b"0123456789"


def test_a_device_that_takes_nothing_is_jammed_and_holds_nobody_up_for_longer_than_its_patience(
    terminal: tuple[SerialLine, int],
) -> None:
    device, _ = terminal
    begin = time.monotonic()
    with pytest.raises(SerialTimeoutException):
        device.write(bytes(200_000))
    assert WRITE_TIMEOUT <= time.monotonic() - begin < WRITE_TIMEOUT + 0.5


def test_a_program_that_is_interrupted_for_longer_than_the_patience_still_sends(
    terminal: tuple[SerialLine, int],
) -> None:
    """A signal's handler takes longer than the time-out, again and again, in the middle of what is being written."""
    device, board = terminal

    def dawdle(_signal: int, _frame: FrameType | None) -> None:
        time.sleep(2.0 * WRITE_TIMEOUT)

    before = signal.signal(signal.SIGALRM, dawdle)
    try:
        for delay in range(1, 12):
            signal.setitimer(signal.ITIMER_REAL, delay * 2e-6)
            assert device.write(b"x" * 50) == 50
            assert os.read(board, 100) == b"x" * 50
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
