"""The compiled firmware's hold on the drivers' EN/DIAG lines: low unless it drives, or a coil's current still dies."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing

import pytest
from board_contact import SteppedContact, Terminal

from control.simulation.emulated import EmulatedBoard, prepare
from control.snapshot import Vector
from tests.simulation.board_bench import windings

LOW = (False, False, False)
UP = (True, True, True)
SHORTEST, LONGEST = 150, 500
"""Milliseconds without drive between which a line goes low."""

QUIET = 0.11
"""Three counts of a sense, A."""


class Lines:
    """An emulated board and its three lines."""

    def __init__(self, terminal: Terminal, board: EmulatedBoard) -> None:
        self.contact = SteppedContact(terminal, board)
        self.board = board

    def until_low(self, coil: int) -> tuple[int, Vector]:
        """Milliseconds for which a coil's line stays up from now on, and the currents when it goes low."""
        for passed in range(1, LONGEST + 20):
            self.contact.run(1)
            if not self.board.released()[coil]:
                return passed, self.contact.samples[-1].currents
        raise AssertionError(f"the line of coil {coil + 1} has not gone low")


@pytest.fixture
def lines() -> Iterator[Lines]:
    with (
        closing(EmulatedBoard(prepare(), windings(), 24.0, realtime=False)) as board,
        closing(Terminal(board.port)) as terminal,
    ):
        lines = Lines(terminal, board)
        lines.contact.run(30)
        yield lines


def test_no_line_is_up_before_the_board_is_armed_and_all_are_while_it_drives(lines: Lines) -> None:
    assert lines.board.released() == LOW
    lines.contact.ready()
    assert lines.board.released() == LOW
    lines.contact.arm()
    assert lines.board.released() == UP
    lines.contact.driving(milliseconds=100)
    assert lines.board.released() == UP


def test_a_bridge_is_opened_only_after_its_coils_current_has_died(lines: Lines) -> None:
    for coil in range(3):
        lines.contact.driving(start=0.5)
        lines.contact.stop()
        passed, currents = lines.until_low(coil)
        assert SHORTEST - 5 <= passed <= LONGEST
        assert abs(currents[coil]) < QUIET
    lines.contact.run(LONGEST)
    assert lines.board.released() == LOW


@pytest.mark.parametrize("coil", [0, 1, 2])
def test_a_dead_sense_does_not_open_a_bridge_at_full_current(lines: Lines, coil: int) -> None:
    """A coil of 125 mH holds 4 J at 8 A, which would go into the supply and destroy the driver."""
    lines.contact.driving(start=0.5)
    lines.board.set_condition("sense_permille", 0, coil + 1)
    lines.contact.stop()
    assert lines.contact.is_zero
    _, currents = lines.until_low(coil)
    assert abs(currents[coil]) < 0.05 * 8.0 + QUIET


def test_a_line_goes_low_after_half_a_second_whatever_the_sense_reads(lines: Lines) -> None:
    lines.contact.driving(start=0.5, milliseconds=200)
    lines.contact.stop()
    lines.contact.run(1)
    lines.board.set_condition("resistance_mohm", 100, 1)  # dies in more than a second
    passed, _ = lines.until_low(0)
    assert LONGEST - 10 <= passed <= LONGEST


def test_a_fault_and_a_reset_end_with_every_line_low(lines: Lines) -> None:
    lines.contact.driving(start=0.5, milliseconds=200)
    lines.board.set_condition("driver_fault", 1, 2)
    lines.contact.run(LONGEST + 10)
    assert lines.board.released() == LOW
    lines.board.set_condition("driver_fault", 0, 2)
    lines.contact.driving(start=0.5, milliseconds=200)
    lines.board.reset()
    lines.contact.run(5)
    assert lines.board.released() == LOW
