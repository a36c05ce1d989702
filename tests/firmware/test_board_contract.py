"""What every board keeps: the twin's process, the compiled firmware in the emulator, and, by --board PORT, a real one.

A test with `any_board` only talks to it; one with `board` also looks at its pins and harms its electrics.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import pytest
from board_contact import BoardContact, SteppedContact

from control.link import wire
from control.link.messages import ARM, BoardCode, Hello, Refusal, Stop
from control.simulation.twin import FIRMWARE_VERSION
from tests.simulation.board_bench import CONFIGURE

TRANSIT = 3
"""Milliseconds that a drive's 52 bytes and the board's attention to them take, at most."""

LIFE = 200
"""Of a drive command, ms."""


# ---- boot and greeting


def test_a_board_boots_disabled_and_says_so_once(board: SteppedContact) -> None:
    assert board.is_zero
    assert board.last_driven == 0
    assert [packet.sequence for packet in board.heard] == [0]
    assert board.banners[0].firmware == FIRMWARE_VERSION
    assert board.banners[0].configuration_hash == 0
    assert board.boot_id != 0


def test_a_board_says_nothing_more_until_it_is_greeted(board: SteppedContact) -> None:
    board.run(500)
    assert len(board.heard) == 1


def test_a_greeting_is_answered_with_its_own_number(any_board: BoardContact) -> None:
    any_board.send(Hello(), sequence=321)
    any_board.run(10)
    assert any_board.heard[-1].sequence == 321 or any_board.reports
    assert 321 in [packet.sequence for packet in any_board.heard]


def test_a_configuration_is_answered_with_its_hash(any_board: BoardContact) -> None:
    any_board.ready()
    assert any_board.state is BoardCode.READY
    assert any_board.report.configuration_hash == wire.configuration_hash(CONFIGURE)


def test_another_version_is_answered_and_refused(any_board: BoardContact) -> None:
    any_board.say(Hello(), version=77)
    assert any_board.banners
    any_board.say(Hello())
    assert any_board.report.last_refusal == Refusal.VERSION
    assert any_board.state is BoardCode.BOOTED or any_board.report.configuration_hash


def test_a_board_reports_a_hundred_times_a_second(any_board: BoardContact) -> None:
    any_board.ready()
    before = len(any_board.reports)
    any_board.run(500)
    times = [report.time for report in any_board.reports[before:]]
    assert 48 <= len(times) <= 52
    assert {later - earlier for earlier, later in pairwise(times)} == {10}


# ---- who may drive


def test_a_board_without_a_configuration_refuses_to_drive(board: SteppedContact) -> None:
    board.say(Hello())
    board.say(board.command(flags=ARM))
    assert board.report.last_refusal == Refusal.STATE
    assert board.state is BoardCode.BOOTED
    assert board.last_driven == 0


def test_only_the_arm_edge_leads_to_current(board: SteppedContact) -> None:
    board.ready()
    board.say(board.command())
    assert board.report.last_refusal == Refusal.STATE
    assert board.last_driven == 0
    board.say(board.command(flags=ARM))
    board.run(100)
    assert board.state is BoardCode.DRIVING
    assert not board.is_zero


def test_a_board_that_drives_takes_no_configuration(any_board: BoardContact) -> None:
    any_board.arm()
    any_board.say(CONFIGURE)
    assert any_board.report.last_refusal == Refusal.STATE
    assert any_board.state is BoardCode.DRIVING


def test_a_drive_for_another_boot_is_refused(any_board: BoardContact) -> None:
    any_board.ready()
    any_board.say(any_board.command(flags=ARM), boot_id=any_board.boot_id ^ 1)
    assert any_board.report.last_refusal == Refusal.BOOT_ID
    assert any_board.state is BoardCode.READY


@pytest.mark.parametrize(
    ("changes", "refusal"),
    [
        ({"flags": 2}, Refusal.FLAGS),
        ({"pivot": 0}, Refusal.PIVOT),
        ({"pivot": 2}, Refusal.PIVOT),
        ({"rate": CONFIGURE.max_rate + 1}, Refusal.RATE),
        ({"rate": -CONFIGURE.max_rate - 1}, Refusal.RATE),
        ({"rate": -(2**31)}, Refusal.RATE),
        ({"tilt": CONFIGURE.max_tilt + 1}, Refusal.TILT),
        ({"field": CONFIGURE.max_field + 1}, Refusal.FIELD),
        ({"time_to_live": 0}, Refusal.LIFETIME),
    ],
)
def test_a_drive_out_of_range_is_refused_and_renews_no_life(
    board: SteppedContact, changes: dict[str, Any], refusal: Refusal
) -> None:
    board.arm()
    armed_at = board.now
    board.say(board.command(**changes))
    assert board.report.last_refusal == refusal
    assert board.state is BoardCode.DRIVING
    for _ in range(20):
        board.say(board.command(**changes))
        board.run(10)
    assert board.report.refused == 21
    assert board.state is BoardCode.EXPIRED
    assert board.last_driven <= armed_at + LIFE + 1


@pytest.mark.parametrize(
    "changes", [{"rate": CONFIGURE.max_rate}, {"tilt": CONFIGURE.max_tilt}, {"pivot": -1}]
)
def test_a_drive_at_the_limit_is_obeyed(any_board: BoardContact, changes: dict[str, Any]) -> None:
    any_board.arm()
    any_board.say(any_board.command(**changes))
    assert any_board.report.last_refusal == Refusal.NONE


# ---- the dead-man


def test_current_lives_as_long_as_its_command_and_no_longer(board: SteppedContact) -> None:
    board.driving()
    sent_at = board.now
    board.say(board.command(time_to_live=120))
    board.run(400)
    assert sent_at + 120 <= board.last_driven + 1 <= sent_at + TRANSIT + 120 + 1
    assert board.state is BoardCode.EXPIRED


def test_no_command_lives_longer_than_the_dead_man(board: SteppedContact) -> None:
    board.driving()
    sent_at = board.now
    board.say(board.command(time_to_live=65535))
    board.run(400)
    assert sent_at + LIFE <= board.last_driven + 1 <= sent_at + TRANSIT + LIFE + 1


def test_an_expired_board_needs_a_new_arm_edge(board: SteppedContact) -> None:
    board.driving()
    board.run(300)
    expired_at = board.now
    board.say(board.command())
    board.run(50)
    assert board.last_driven < expired_at
    board.say(board.command(flags=ARM))
    board.run(50)
    assert board.state is BoardCode.DRIVING


def test_stop_zeroes_at_once_whatever_its_number(board: SteppedContact) -> None:
    for number in (None, 0, 40000):
        board.driving(milliseconds=200)
        sent_at = board.now
        board.say(Stop(), **({} if number is None else {"sequence": number}))
        board.run(50)
        assert board.last_driven <= sent_at + TRANSIT
        assert board.state is BoardCode.STOPPED
        board.sequence = board.report.last_sequence


def test_old_and_repeated_commands_do_not_renew_the_life(board: SteppedContact) -> None:
    board.driving()
    old = wire.encode(board.command(), board.sequence, board.boot_id)
    older = wire.encode(board.command(flags=ARM), board.sequence - 1, board.boot_id)
    board.run(10)
    begun = board.now
    for _ in range(60):
        board.put(old + older)
        board.run(5)
    assert board.last_driven <= begun + LIFE + 1
    assert board.state is BoardCode.EXPIRED
    assert board.report.stale >= 100


def test_the_numbers_may_run_ahead_by_the_window_and_no_further(any_board: BoardContact) -> None:
    any_board.arm()
    any_board.say(any_board.command(), sequence=any_board.sequence + wire.SEQUENCE_WINDOW)
    assert any_board.report.last_refusal == Refusal.NONE
    any_board.say(any_board.command(), sequence=any_board.sequence + wire.SEQUENCE_WINDOW + 1)
    assert any_board.report.last_refusal == Refusal.SEQUENCE


# ---- the line


def test_garbage_costs_the_frame_that_it_touches_and_no_other(any_board: BoardContact) -> None:
    any_board.ready()
    before = any_board.report
    any_board.put(bytes(range(1, 120)))
    any_board.run(10)
    any_board.say(any_board.command(flags=ARM))
    after = any_board.report
    assert any_board.state is BoardCode.DRIVING
    assert after.bad == before.bad + 1
    assert after.refused == before.refused


def test_half_a_frame_does_not_take_the_next_one_with_it(any_board: BoardContact) -> None:
    any_board.ready()
    frame = wire.encode(any_board.command(flags=ARM), any_board.sequence + 1, any_board.boot_id)
    any_board.put(frame[:20])
    any_board.run(20)
    any_board.say(any_board.command(flags=ARM))
    assert any_board.state is BoardCode.DRIVING


@pytest.mark.parametrize("bit", [8, 60, 200, 300, 370])
def test_a_drive_with_a_flipped_bit_is_not_obeyed(any_board: BoardContact, bit: int) -> None:
    any_board.ready()
    frame = bytearray(wire.encode(any_board.command(flags=ARM), any_board.sequence + 1, any_board.boot_id))
    frame[bit // 8] ^= 1 << bit % 8
    any_board.put(bytes(frame))
    any_board.run(10)
    assert any_board.state is BoardCode.READY
    assert any_board.report.bad >= 1
