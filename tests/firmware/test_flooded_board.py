"""The compiled firmware while its line is full, 50 bytes in each millisecond: nothing of it keeps a current alive."""

from __future__ import annotations

import random
from collections.abc import Callable

import pytest
from board_contact import SteppedContact, stepped

from control.link import wire
from control.link.messages import BoardCode, Stop

LIFE = 200
"""Of a drive command, ms."""

FULL_LINE = 50
"""Bytes of a millisecond."""


def noise(board: SteppedContact) -> Callable[[], bytes]:
    source = random.Random(board.sequence)
    return lambda: source.randbytes(FULL_LINE)


def delimiters(_board: SteppedContact) -> Callable[[], bytes]:
    return lambda: bytes(FULL_LINE)


def one_endless_frame(_board: SteppedContact) -> Callable[[], bytes]:
    return lambda: b"\1" * FULL_LINE


def repeated_command(board: SteppedContact) -> Callable[[], bytes]:
    old = wire.encode(board.command(), board.sequence, board.boot_id)
    return lambda: old[-FULL_LINE:]


FLOODS = (noise, delimiters, one_endless_frame, repeated_command)


@pytest.mark.parametrize("flood", FLOODS)
def test_a_full_line_delays_neither_the_dead_man_nor_a_report(
    flood: Callable[[SteppedContact], Callable[[], bytes]],
) -> None:
    with stepped("avr") as board:
        board.driving(start=0.5, milliseconds=200)
        board.say(board.command(0.5))
        last_command, begun, boot_id = board.now, len(board.reports), board.boot_id
        bytes_of_a_millisecond = flood(board)
        for _ in range(2 * LIFE):
            board.put(bytes_of_a_millisecond())
            board.run(1)
        assert last_command + LIFE - 5 <= board.last_driven <= last_command + LIFE + 1
        reports = board.reports[begun:]
        assert reports[-1].state == BoardCode.EXPIRED
        assert reports[-1].time - reports[0].time == 10 * (len(reports) - 1) >= 2 * LIFE - 20
        assert board.boot_id == boot_id


def test_a_stop_in_the_middle_of_a_full_line_is_obeyed_at_once() -> None:
    with stepped("avr") as board:
        board.driving(start=0.5, milliseconds=200)
        bytes_of_a_millisecond = noise(board)
        for _ in range(20):
            board.put(bytes_of_a_millisecond())
            board.run(1)
        board.put(b"\0")
        board.send(Stop())
        sent_at = board.now
        for _ in range(20):
            board.put(bytes_of_a_millisecond())
            board.run(1)
        assert sent_at - 2 <= board.last_driven <= sent_at + 2
