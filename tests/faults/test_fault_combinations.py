"""Row 34: faults seldom come alone. The gravest one decides; clearing one cause keeps the other."""

from __future__ import annotations

import random

import pytest

from control.safety import Refused
from control.simulation.faults.injection import KINDS
from control.snapshot import RigState
from tests.faults.fault_bench import FaultBench, fault_bench
from tests.faults.invariants import (
    OVERSHOOT_UNSENSED,
    check_limits,
    check_recording,
    check_stays_zero,
    zero_at,
)

STOPPING = ("robot_hidden", "supply_off", "driver_fault")


@pytest.mark.parametrize(
    ("first", "second", "after"),
    [
        ("robot_hidden", "supply_off", RigState.DISARMED),
        ("supply_off", "robot_hidden", RigState.DISARMED),
        ("robot_hidden", "driver_fault", RigState.FAULT),
        ("driver_fault", "line_unplugged", RigState.FAULT),
        ("camera_unplugged", "board_reset", RigState.FAULT),
    ],
)
def test_the_gravest_of_two_faults_decides(
    bench: FaultBench, first: str, second: str, after: RigState
) -> None:
    """When two things fail, the graver one decides what you have to do, in whichever order they came."""
    bench.walk()
    bench.inject(first)
    bench.run_for(0.05)
    bench.inject(second)
    bench.run_for(0.7)
    assert bench.snapshot.rig is after, bench.snapshot.reason


def test_clearing_one_cause_keeps_the_other(bench: FaultBench) -> None:
    """When one of two causes has gone, the rig still names the other, and cannot be armed."""
    bench.walk()
    bench.inject("supply_off")
    bench.inject("robot_hidden")
    bench.run_for(0.5)
    assert {"supply", "lost"} <= {fault.code for fault in bench.snapshot.faults}
    bench.mend("robot_hidden")
    assert [fault.code for fault in bench.snapshot.faults] == ["supply"]
    with pytest.raises(Refused, match="supply"):
        bench.arm_now()
    bench.mend("supply_off")
    bench.go_on()


def test_the_first_cause_of_a_latched_fault_is_kept(bench: FaultBench) -> None:
    """What went wrong first stays on the page, whatever goes wrong after it."""
    bench.walk()
    bench.inject("controller_raises")
    bench.run_for(0.2)
    bench.inject("driver_fault")
    bench.run_for(0.3)
    assert bench.snapshot.faults[0].code == "controller"
    assert "raised" in bench.snapshot.reason


def test_no_storm_of_faults_drives_a_coil_too_far_or_by_itself(full: bool) -> None:
    """Whatever fails together and in whatever order: no coil carries more than it may, and none comes back on
    without you."""
    for seed in range(20 if full else 3):
        with fault_bench() as bench:
            storm(bench, random.Random(seed))


def storm(bench: FaultBench, dice: random.Random) -> None:
    bench.walk()
    for _ in range(6):
        bench.inject(dice.choice([name for name in KINDS if name != "controller_hangs"]))
        bench.run_for(dice.uniform(0.05, 0.3))
    bench.inject(dice.choice(STOPPING))
    bench.run_for(1.0)
    stopped = bench.board.milliseconds
    assert bench.snapshot.rig is not RigState.RUNNING
    bench.faults.clear_all()
    bench.run_for(1.0)
    trace = bench.trace
    check_limits(trace.samples, bench.electrics, OVERSHOOT_UNSENSED)
    check_stays_zero(trace, zero_at(trace.samples, stopped - 1))
    walked_until = max(snapshot.time for snapshot in trace.snapshots if snapshot.run is not None)
    check_recording(bench.recording_at_the_end(), walked_until)
