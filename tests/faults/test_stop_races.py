"""An emergency stop at the worst instant: between the question whether it has come and the command that follows."""

from __future__ import annotations

import contextlib
from collections.abc import Callable

import pytest

from control.link.conversion import DriveCommand
from control.model import PIVOT_A
from control.safety import Refused
from control.simulation.twin import BoardCode
from control.snapshot import RigState
from tests.faults.fault_bench import FaultBench
from tests.faults.invariants import check_stays_zero, is_driven


def stop_at_the_next_command(bench: FaultBench) -> None:
    """The link asks for the time first of all: then comes the stop, as a signal may at any instruction."""
    link = bench.machine.link
    clock = link._clock

    def interrupted() -> float:
        link._clock = clock
        bench.loop.estop()
        return clock()

    link._clock = interrupted


def arm(bench: FaultBench) -> None:
    bench.arm_now()


def calibrate(bench: FaultBench) -> None:
    """A calibration's arm edge."""
    level = (500.0, 0.0, 0.0), (0.0, 500.0, 0.0), (0.0, 0.0, 100.0)
    bench.loop.parts.actuation.hold_steady(
        DriveCommand(PIVOT_A, 0.0, 0.0, 0.0, 0.010, level, time_to_live=0.15, start_heading=0.0)
    )


@pytest.mark.parametrize("energise", [arm, calibrate])
def test_a_stop_that_comes_while_the_coils_are_switched_on_has_the_last_word(
    bench: FaultBench, energise: Callable[[FaultBench], None]
) -> None:
    """When you press STOP at the very instant at which the coils come on, the board hears it after that command."""
    bench.until(lambda snapshot: not snapshot.faults)
    stop_at_the_next_command(bench)
    energise(bench)
    bench.faults.inject("loop_stalls", {"stall_ms": 12.0})
    assert bench.board.state is BoardCode.STOPPED
    stopped = bench.board.milliseconds
    bench.run_for(0.5)
    check_stays_zero(bench.trace, stopped)
    assert bench.snapshot.rig is RigState.FAULT
    assert bench.snapshot.faults[0].code == "estop"


def test_of_two_stops_the_first_cause_is_kept(bench: FaultBench) -> None:
    """When the watchdog has stopped a controller that hangs, pressing STOP as well does not hide why."""
    bench.until(lambda snapshot: not snapshot.faults)
    bench.loop.estop("controller", "the controller hangs")
    bench.loop.estop()
    bench.tick()
    bench.loop.latch_estop()
    bench.tick()
    assert (bench.snapshot.faults[0].code, bench.snapshot.reason) == ("controller", "the controller hangs")
    bench.loop.reset()
    bench.loop.estop()
    assert bench.tick().faults[0].code == "estop"


def test_arming_right_after_a_stop_is_refused(bench: FaultBench) -> None:
    """A stop by signal holds at once, before the next tick has told of it."""
    bench.until(lambda snapshot: not snapshot.faults)
    bench.loop.estop()
    with pytest.raises(Refused, match="reset it first"):
        bench.arm_now()


@pytest.mark.parametrize("energise", [arm, calibrate])
def test_nothing_is_switched_on_after_a_stop_until_it_is_reset(
    bench: FaultBench, energise: Callable[[FaultBench], None]
) -> None:
    """After STOP no way leads to the coils, not even one that was begun before it."""
    bench.until(lambda snapshot: not snapshot.faults)
    bench.loop.parts.actuation.stop_from_outside()
    stopped = bench.board.milliseconds
    with contextlib.suppress(Refused):
        energise(bench)
    bench.run_for(0.3)
    assert not any(map(is_driven, bench.trace.after(stopped)))
