"""Rows 4, 13, 14 and 21: the board, its supply, its drivers and the coils."""

from __future__ import annotations

import pytest

from control.safety import Refused
from control.snapshot import RigState
from tests.faults.fault_bench import FaultBench
from tests.faults.invariants import check_announced, check_limits, check_stays_zero, check_zero
from tests.faults.promises import PROMISES
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
    """When a coil's lead comes off, the rig disarms 0.1 s after that coil is asked for a current, and names it."""
    keeps_its_promise("coil_open")


@pytest.mark.parametrize(("coil", "walked"), [("x", 0.55), ("x", 0.66), ("y", 0.22)])
def test_a_robot_that_turns_wrongly_for_want_of_a_current_does_not_accuse_the_leads_of_being_exchanged(
    bench: FaultBench, coil: str, walked: float
) -> None:
    """A coil without current lets the robot turn against its field; it is the missing current that you are told of."""
    bench.walk()
    bench.run_for(walked)
    bench.inject("coil_open", coil=coil)
    bench.run_for(0.8)
    (event,) = (event for event in bench.trace.events if event.severity == "error")
    assert event.code == "coil"
    assert f"coil {coil} shows no current" in event.message


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


def test_a_driver_fault_of_a_held_rig_is_found_when_it_is_resumed(bench: FaultBench) -> None:
    """When a motor driver gives up while the rig is held, its pin says so only once the bridges are on again:
    resume, and all coils are off within 2 milliseconds of that; a reset is needed."""
    bench.walk()
    bench.loop.pause()
    bench.run_for(0.3)
    bench.inject("driver_fault")
    bench.run_for(0.3)
    assert bench.snapshot.rig is RigState.HELD
    resumed = bench.board.milliseconds
    bench.loop.resume()
    bench.run_for(0.6)
    assert bench.snapshot.rig is RigState.FAULT
    assert "driver_fault" in bench.snapshot.reason
    check_limits(bench.trace.samples, bench.electrics)
    zero = check_zero(bench.trace, bench.electrics, resumed + 2)
    check_stays_zero(bench.trace, zero)
    check_announced(bench.trace, "board", resumed * 1e-3)


def test_a_reset_is_not_undone_by_what_the_board_reported_before(bench: FaultBench) -> None:
    """A reset that greets the board anew holds, however late its first new report comes."""
    bench.walk()
    bench.inject("driver_fault")
    bench.run_for(0.3)
    bench.faults.clear("driver_fault")
    bench.run_for(0.3)
    bench.loop.reset()
    for _ in range(100):  # looked at so often that the answer to the greeting comes alone
        bench.machine.camera.pass_time(0.001)  # type: ignore[attr-defined]
        bench.loop.tick(None, bench.now)
        assert bench.loop.state is RigState.DISARMED
    assert bench.machine.link.is_ready
    bench.go_on()


def test_an_arming_that_does_not_reach_the_board_leaves_everything_at_rest(bench: FaultBench) -> None:
    """When the line fails at the very moment of arming, arming is refused, and nothing believes in a field."""
    bench.until(lambda snapshot: not snapshot.faults)
    bench.inject("line_jammed")
    with pytest.raises(Refused, match="jammed"):
        bench.arm_now()
    assert bench.loop.state is RigState.DISARMED
    assert not bench.loop.parts.field.is_on
    bench.run_for(0.3)
    assert not any(any(sample.duty) for sample in bench.trace.samples)


@pytest.mark.parametrize("name", ["board_reset", "supply_off"])
def test_what_happens_to_the_board_of_a_held_rig_is_not_overlooked(bench: FaultBench, name: str) -> None:
    """A held rig has no current, but it is about to go on: a board that resets, or a supply that fails, ends the
    hold as it would end the run."""
    promise = PROMISES[name]
    bench.walk()
    bench.loop.pause()
    bench.run_for(0.3)
    fault = bench.inject(name)
    bench.run_for(0.6)
    assert bench.snapshot.rig is promise.after
    check_announced(bench.trace, promise.code, fault * 1e-3)
    check_stays_zero(bench.trace, fault)
