"""Row 3: a camera whose latency is known may be late; the robot walks as if it were not."""

from __future__ import annotations

import pytest

from control.runs import RunRequest
from control.snapshot import RigState
from server.settings import RigFile
from tests.faults.fault_bench import EIGHT, fault_bench
from tests.faults.invariants import nothing_left_behind

WALK = 4.5
"""Seconds: about ten pivot switches, whose slip falls between two pictures here and there."""


@pytest.mark.parametrize("latency_ms", [20.0, 40.0, 57.0, 60.0, 80.0])
def test_however_late_the_camera_is_no_sighting_of_a_slipping_robot_is_refused(latency_ms: float) -> None:
    with (
        nothing_left_behind(),
        fault_bench(RigFile().with_simulation(seed=2, latency_ms=latency_ms)) as bench,
    ):
        bench.arm()
        bench.loop.start("a run", RunRequest(EIGHT))
        until = bench.now + WALK
        while bench.now < until:
            snapshot = bench.tick()
            assert snapshot.rig is RigState.RUNNING, snapshot.reason
            assert snapshot.tracking_reason == ""
