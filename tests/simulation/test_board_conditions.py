"""What a simulated board shows when its supply, drivers, coils, leads or senses are not as they should be."""

from __future__ import annotations

import math

import pytest
from board_bench import Bench, windings

from control.link.messages import BoardCode, ResetCause
from control.simulation.conditions import CONDITIONS, ConditionRefused


def settled(bench: Bench) -> tuple[float, float, float]:
    """The currents half a second later, driven all the time."""
    for _ in range(50):
        bench.turn(0.0, 0.0)
        bench.run(8)
    return bench.board.currents


def test_a_true_board_is_as_it_is_without_conditions() -> None:
    plain, told = Bench().driving(start=0.4), Bench()
    for coil in (1, 2, 3):
        told.board.set_condition("sense_permille", 1000, coil)
        told.board.set_condition("resistance_mohm", round(windings()[coil - 1].resistance * 1e3), coil)
        for name in ("driver_fault", "open_coil", "swapped"):
            told.board.set_condition(name, 0, coil)
    told.board.set_condition("supply_mV", 24000)
    told.driving(start=0.4)
    assert told.board.currents == plain.board.currents


def test_a_driver_fault_of_any_coil_zeroes_all_bridges_and_outlives_a_reset() -> None:
    for coil in (1, 2, 3):
        bench = Bench().driving()
        bench.board.set_condition("driver_fault", 1, coil)
        bench.run(1)
        assert bench.board.state == BoardCode.FAULT
        assert bench.board.drive_is_zero
        bench.board.reset()
        bench.board.set_condition("driver_fault", 0, 1 if coil != 1 else 2)
        assert bench.board.twin.driver_fault


def test_a_sense_that_shows_too_much_trips_the_over_current() -> None:
    bench = Bench().driving(start=math.pi / 2)
    bench.board.set_condition("sense_permille", 3000, 1)
    bench.run(5)
    assert bench.board.state == BoardCode.FAULT


def test_an_open_coil_carries_no_current() -> None:
    bench = Bench().driving(start=0.4)
    assert min(abs(current) for current in bench.board.currents) > 1.0
    bench.board.set_condition("open_coil", 1, 2)
    bench.run(1)
    x, y, z = bench.board.currents
    assert y == 0.0
    assert min(abs(x), abs(z)) > 1.0


def test_exchanged_leads_reverse_the_current_and_the_sense_cannot_tell() -> None:
    true, swapped = Bench().driving(start=0.4), Bench()
    swapped.board.set_condition("swapped", 1, 2)
    swapped.driving(start=0.4)
    x, y, z = true.board.currents
    assert swapped.board.currents == pytest.approx((x, -y, z))
    assert swapped.board.state == BoardCode.DRIVING


def test_a_coil_of_more_resistance_needs_more_duty_for_its_current() -> None:
    bench = Bench().driving(start=0.0)
    cold = bench.board.duty[1]
    before = bench.board.currents[1]
    bench.board.set_condition("resistance_mohm", 2400, 2)
    after = settled(bench)[1]
    assert after == pytest.approx(before, abs=0.1)
    assert bench.board.duty[1] == pytest.approx(1.2 * cold, rel=0.05)


def test_a_supply_that_is_off_leaves_no_current() -> None:
    bench = Bench().driving(start=0.4)
    bench.board.set_condition("supply_mV", 0)
    assert bench.board.supply == 0.0
    assert max(abs(current) for current in settled(bench)) < 0.01


def test_a_reset_takes_the_next_boot_id_and_says_that_it_came_from_outside() -> None:
    bench = Bench(boot_id=0xFFFF).driving()
    bench.board.reset()
    bench.run(5)
    assert bench.board.boot_id == 1
    assert bench.banners[-1].reset_cause == ResetCause.EXTERNAL
    assert bench.board.drive_is_zero


@pytest.mark.parametrize(
    ("name", "value", "coil"),
    [
        ("fire", 1, None),
        ("supply_mV", 65001, None),
        ("supply_mV", -1, None),
        ("supply_mV", 24000, 1),
        ("driver_fault", 2, 1),
        ("driver_fault", True, 1),
        ("driver_fault", 1, None),
        ("driver_fault", 1, 0),
        ("driver_fault", 1, 4),
        ("sense_permille", 1.5, 1),
        ("resistance_mohm", 0, 1),
    ],
)
def test_a_condition_that_there_is_not_is_refused_and_changes_nothing(
    name: str, value: int, coil: int | None
) -> None:
    bench = Bench().driving(start=0.4)
    twin = Bench().driving(start=0.4)
    with pytest.raises(ConditionRefused):
        bench.board.set_condition(name, value, coil)
    assert settled(bench) == settled(twin)


def test_every_condition_says_what_it_means() -> None:
    assert all(condition.meaning and condition.least < condition.most for condition in CONDITIONS.values())
