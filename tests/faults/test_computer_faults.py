"""Rows 17 to 19 and 31: the computer's time and numbers, and the controllers that run on it."""

from __future__ import annotations

from dataclasses import replace

import pytest

from control.snapshot import RigState
from tests.faults.fault_bench import FaultBench
from tests.faults.invariants import check_announced, check_limits, check_stays_zero, check_zero
from tests.faults.promises import PROMISES
from tests.faults.trial import keeps_its_promise, try_out


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


@pytest.mark.parametrize("stall_ms", [140.0, 150.0, 160.0, 180.0, 199.0, 205.0, 225.0, 250.0])
def test_a_short_stall_is_held_and_not_blamed_on_coils_or_board(bench: FaultBench, stall_ms: float) -> None:
    """When the computer is busy for just longer than a command lives, the run is kept: you resume. Nothing is said
    to be broken that is not."""
    bench.walk()
    fault = bench.inject("loop_stalls", stall_ms=stall_ms)
    bench.run_for(0.6)
    codes = {event.code for event in bench.trace.events if event.severity == "error"}
    assert bench.snapshot.rig in (RigState.RUNNING, RigState.HELD), bench.snapshot.reason
    assert codes <= {"expired", "stall"}
    if bench.snapshot.rig is RigState.HELD:
        check_stays_zero(bench.trace, check_zero(bench.trace, bench.electrics, fault))
        check_announced(bench.trace, codes.pop(), fault * 1e-3)
        bench.go_on()
    check_limits(bench.trace.samples, bench.electrics)


@pytest.mark.parametrize("answer", ["inf", "text", "nothing", "pivot"])
def test_whatever_nonsense_a_controller_returns_latches(answer: str) -> None:
    """Endless, a word, nothing at all, a pivot that no robot has: the coils are off at once."""
    try_out(replace(PROMISES["controller_nonsense"], parameters={"answer": answer}))
