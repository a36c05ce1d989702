"""Rows 17 to 19 and 31: the computer's time and numbers, and the controllers that run on it."""

from __future__ import annotations

from tests.faults.trial import keeps_its_promise


def test_a_loop_that_stalls_is_held() -> None:
    """When the computer is too busy for the rig, the board switches the coils off by itself after 0.15 s,
    and the rig holds when the computer is back."""
    keeps_its_promise("loop_stalls")


def test_a_computer_that_slept_is_held() -> None:
    """When the computer slept or its clock jumped, the coils were off after 0.15 s, and nothing moves
    until you resume."""
    keeps_its_promise("computer_sleeps")


def test_a_report_that_is_no_number_is_refused() -> None:
    """Currents that are not numbers are not believed; a board that sends nothing else counts as silent."""
    keeps_its_promise("report_nan")


def test_a_controller_that_fails_latches() -> None:
    """When a controller fails, the coils are off at once, and the page shows what it said."""
    keeps_its_promise("controller_raises")


def test_a_controller_that_hangs_lets_its_command_age_out() -> None:
    """When a controller hangs, its last command is worth 0.15 s; then the board switches the coils off by
    itself."""
    keeps_its_promise("controller_hangs")


def test_a_controller_that_returns_nonsense_latches() -> None:
    """When a controller wants what no robot can do, the coils are off at once, and the page shows what it
    wanted."""
    keeps_its_promise("controller_nonsense")
