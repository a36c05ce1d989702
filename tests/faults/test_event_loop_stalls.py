"""Row 17: the program's own event loop stands still while the board's time goes on. In real time."""

from __future__ import annotations

import asyncio
import time
from pathlib import Path

import pytest

from control.snapshot import RigState
from server.assembly import build_machine
from server.rig import Rig
from server.rig_file import load_rig_file
from tests.faults.conftest import SeparateBoard
from tests.faults.invariants import (
    Electrics,
    Trace,
    check_limits,
    check_stays_zero,
    check_zero,
    is_driven,
    nothing_left_behind,
)

pytestmark = [pytest.mark.exclusive, pytest.mark.anyio]

STALL = 0.5
PATIENCE = 20.0


async def until(rig: Rig, *states: RigState) -> None:
    async with asyncio.timeout(PATIENCE):
        while rig.snapshot.rig not in states:
            await asyncio.sleep(0.01)


async def test_an_event_loop_that_stands_still_is_held_and_the_board_does_not_wait_for_it(
    board: SeparateBoard, tmp_path: Path, electrics: Electrics
) -> None:
    """When the program has no time for the rig for half a second, the board switches the coils off within 200 ms,
    the rig holds and says so within a second, and nothing moves until you resume."""
    with nothing_left_behind():
        rig = Rig(build_machine(load_rig_file(board.rig_file(tmp_path)), realtime=True))
        await rig.start()
        try:
            await armed(rig)
            board.monitor.take()
            began = board.milliseconds
            time.sleep(STALL)
            await until(rig, RigState.HELD)
            held = rig.snapshot.time
            await asyncio.sleep(0.3)
            trace = Trace(board.monitor.take())
        finally:
            await rig.stop()
    assert rig.snapshot.rig is RigState.HELD
    event = next(event for event in rig.events if event.code in ("stall", "expired"))
    assert 0.0 <= held - event.time <= 1.0
    check_limits(trace.samples, electrics)
    zero = check_zero(trace, electrics, began)
    check_stays_zero(trace, zero)
    assert not is_driven(trace.samples[-1])


async def armed(rig: Rig) -> None:
    """With the field up."""
    async with asyncio.timeout(PATIENCE):
        while rig.snapshot.faults or rig.snapshot.tracking != "locked":
            await asyncio.sleep(0.01)
    await rig.arm()
    await asyncio.sleep(0.5)
    assert rig.snapshot.rig is RigState.ARMED, rig.snapshot.reason
