"""Rows 4, 13, 14 and 21: the board, its supply, its drivers and the coils."""

from __future__ import annotations

from tests.faults.trial import keeps_its_promise


def test_a_board_that_resets_latches() -> None:
    """When the board resets, its coils are off at once and stay off until you reset and arm, although it
    is greeted and configured anew by itself."""
    keeps_its_promise("board_reset")


def test_a_supply_that_is_switched_off_disarms() -> None:
    """When the coils' supply is off while the board lives on from USB, the rig disarms and says so."""
    keeps_its_promise("supply_off")


def test_a_supply_that_sags_disarms() -> None:
    """When the coils' supply sags, the rig disarms and says so."""
    keeps_its_promise("supply_low")


def test_a_driver_fault_latches() -> None:
    """When a motor driver gives up, the board switches all coils off, and a reset is needed."""
    keeps_its_promise("driver_fault")


def test_a_broken_lead_disarms_and_is_named() -> None:
    """When a coil's lead comes off, the rig disarms after 0.1 s and names the coil."""
    keeps_its_promise("coil_open")


def test_a_dead_current_sense_disarms_and_is_named() -> None:
    """When a current sense shows nothing, the rig disarms after 0.1 s. Until then the board, which cannot
    know better, may drive up to a fifth more than the limit: what the supply can give."""
    keeps_its_promise("sense_dead")


def test_an_over_current_latches() -> None:
    """When much more current flows than may, the board switches all coils off within 0.05 s, and a reset
    is needed."""
    keeps_its_promise("sense_wrong")


def test_a_coil_of_another_resistance_disarms() -> None:
    """When a coil cannot carry what is commanded, the rig stops as soon as that is asked of it, and names the coil."""
    keeps_its_promise("coil_resistance")


def test_exchanged_leads_do_not_drive_the_robot_away() -> None:
    """When a coil's leads are exchanged and the robot turns the wrong way, it is driven for 0.4 s at most."""
    keeps_its_promise("coil_swapped")
