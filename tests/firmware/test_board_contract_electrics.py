"""What every simulated board keeps when its supply, drivers, coils or senses fail, and when it is reset."""

from __future__ import annotations

import pytest
from board_contact import SteppedContact

from control.link.messages import ARM, BoardCode, Flag, Hello, ResetCause


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
