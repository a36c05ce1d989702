"""Rows 9 to 12: the serial line between computer and board."""

from __future__ import annotations

import pytest

from control.snapshot import RigState
from tests.faults.fault_bench import FaultBench
from tests.faults.trial import keeps_its_promise


def test_an_unplugged_board_disarms() -> None:
    """When the board's cable comes out, the rig disarms at once and the board switches its coils off by
    itself; plugged in again it is greeted anew, and stays disarmed."""
    keeps_its_promise("line_unplugged")


def test_a_silent_board_disarms() -> None:
    """When the board says nothing for 0.3 s, the rig disarms."""
    keeps_its_promise("line_silent")


def test_a_jammed_line_disarms_and_delays_nobody() -> None:
    """When the port takes no bytes any more, the rig disarms, the board switches its coils off by itself,
    and the loop keeps its pace."""
    keeps_its_promise("line_jammed")


def test_garbage_on_the_line_disarms() -> None:
    """When interference spoils more than a tenth of the messages, the rig disarms; no spoilt one is
    obeyed."""
    keeps_its_promise("line_garbage")


def test_lost_messages_are_made_up_for() -> None:
    """When a third of the messages is lost, the robot walks on: each of them stands for itself."""
    keeps_its_promise("line_loses")


def test_repeated_messages_are_not_obeyed_twice() -> None:
    """An old message that comes again is not obeyed, and does not keep the coils on."""
    keeps_its_promise("line_repeats")


def test_overtaken_messages_are_not_obeyed() -> None:
    """A message that was overtaken by a newer one is not obeyed."""
    keeps_its_promise("line_reorders")


def test_a_slow_line_disarms_and_is_named() -> None:
    """When the line delays every message by a tenth of a second, a stop would come late: the rig disarms, and
    says that it is the line."""
    keeps_its_promise("line_slow")


@pytest.mark.parametrize("delay_ms", [60.0, 80.0, 120.0, 150.0, 200.0, 400.0])
def test_a_slow_line_never_accuses_the_coils(bench: FaultBench, delay_ms: float) -> None:
    """However slow the line becomes, the rig stops, and does not send you to look for swapped leads."""
    bench.walk()
    bench.inject("line_slow", delay_ms=delay_ms)
    bench.until(lambda snapshot: snapshot.rig is not RigState.RUNNING)
    bench.run_for(0.5)
    assert "sign" not in {event.code for event in bench.trace.events}
    assert bench.snapshot.rig in (RigState.HELD, RigState.DISARMED)
