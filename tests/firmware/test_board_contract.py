"""What every board keeps: the twin's process, the compiled firmware in the emulator, and, by --board PORT, a real one.

A test with `any_board` only talks to it; one with `board` also looks at its pins and harms its electrics.
"""

from __future__ import annotations

from contextlib import closing
from itertools import pairwise
from typing import Any

import pytest
from board_contact import BoardContact, SteppedContact

from control.link import wire
from control.link.messages import ARM, BoardCode, Flag, Hello, Refusal, ResetCause, Stop
from control.simulation.lockstep import RemoteBoard
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


# ---- its electrics


def test_a_driver_fault_zeroes_every_bridge_and_stays_until_a_greeting(board: SteppedContact) -> None:
    for coil in (1, 2, 3):
        board.driving(start=0.5, milliseconds=200)
        failed_at = board.now
        board.board.set_condition("driver_fault", 1, coil)
        board.run(30)
        assert board.last_driven <= failed_at + 2
        assert board.state is BoardCode.FAULT
        assert board.report.flags & Flag.DRIVER_FAULT
        board.board.set_condition("driver_fault", 0, coil)
        board.say(board.command(flags=ARM))
        assert board.state is BoardCode.FAULT
        board.say(Hello())
        assert board.state is BoardCode.BOOTED


def test_too_much_current_trips_within_four_milliseconds(board: SteppedContact) -> None:
    board.driving(start=0.5)
    failed_at = board.now
    board.board.set_condition("sense_permille", 10_000, 2)
    board.run(30)
    assert board.last_driven <= failed_at + 4
    assert board.state is BoardCode.FAULT
    assert board.report.flags & Flag.OVER_CURRENT


def test_a_weak_supply_is_reported_and_a_strong_one_is_not(board: SteppedContact) -> None:
    board.driving()
    assert not board.report.flags & Flag.SUPPLY_LOW
    assert board.report.supply == pytest.approx(24000, abs=60)
    board.board.set_condition("supply_mV", 15000)
    board.say(board.command())
    assert board.report.flags & Flag.SUPPLY_LOW
    assert board.report.supply == pytest.approx(15000, abs=60)


def test_the_current_follows_the_command_on_all_three_coils(board: SteppedContact) -> None:
    """The field at 0.5 rad and 25 degrees of tilt, 0.8 A a mT: what the twin's own tests hold for 10 mT."""
    board.driving(start=0.5)
    told = board.report.commanded
    for true, commanded in zip(board.samples[-1].currents, told, strict=True):
        assert abs(commanded) > 2000
        assert true == pytest.approx(commanded * 1e-3, abs=0.08)


def test_after_a_stop_the_current_dies_with_the_coils_own_time_constant(board: SteppedContact) -> None:
    board.driving(start=0.5)
    board.stop()
    board.run(160)
    assert max(abs(current) for current in board.samples[-1].currents) < 0.05 * 8.0


def test_a_reset_leaves_zero_and_a_board_that_has_to_be_told_everything(board: SteppedContact) -> None:
    board.driving()
    boot_id = board.boot_id
    board.board.reset()
    reset_at = board.now
    board.say(board.command(), boot_id=boot_id)
    board.run(60)
    assert board.last_driven <= reset_at
    assert board.banners[-1].reset_cause == ResetCause.EXTERNAL
    assert board.banners[-1].configuration_hash == 0
    assert board.boot_id == boot_id + 1
    board.say(Hello())
    assert board.state is BoardCode.BOOTED


# ---- its control port


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
