"""The electrical half of the simulated board, and the serial line at its pace."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from board_bench import CALM, Bench, windings

from control.link import wire
from control.link.messages import Hello
from control.simulation.board import TwinBoard, Winding


def test_currents_decay_with_the_coils_own_time_constants_once_the_drive_is_zero() -> None:
    bench = Bench().driving(start=0.7)
    bench.stop()
    before = bench.board.currents
    bench.run(100)
    for coil, start, now in zip(windings(), before, bench.board.currents, strict=True):
        assert now == pytest.approx(start * math.exp(-0.1 * coil.resistance / coil.inductance), rel=1e-9)


def test_no_current_is_left_after_five_time_constants() -> None:
    bench = Bench().driving(start=0.7)
    bench.stop()
    bench.run(250)
    assert max(abs(current) for current in bench.board.currents) < 0.05


def test_the_step_is_the_exact_solution_for_the_duty_of_each_millisecond() -> None:
    """i' = a i + (1 - a) / R * duty * V with a = exp(-R dt / L), whatever the duty does."""
    bench = Bench().driving(start=0.7)
    bench.turn(1.2, 2.0)
    for _ in range(50):
        before = bench.board.currents
        after = bench.board.advance(1)[0]
        for k, (coil, steps) in enumerate(zip(windings(), (800, 800, 100), strict=True)):
            decay = math.exp(-1e-3 * coil.resistance / coil.inductance)
            voltage = bench.board.duty[k] / steps * 24.0
            expected = decay * before[k] + (1 - decay) * voltage / coil.resistance
            assert after[k] == pytest.approx(expected, abs=1e-9)


def test_a_message_takes_the_time_of_its_bytes() -> None:
    bench = Bench().driving()
    frame = wire.encode(replace(CALM, rate=5), bench.sequence + 1, 7)
    bench.board.write(b"\x01" * 51 + frame)  # 100 bytes: 2 ms at 500 kbaud
    good = bench.board.twin._good
    bench.board.advance(1)
    assert bench.board.twin._good == good
    bench.board.advance(1)
    assert bench.board.twin._good == good + 1


def test_what_the_host_does_not_read_is_bounded() -> None:
    bench = Bench()
    bench.say(Hello())
    bench.board.advance(3000)
    assert bench.board.waiting < 4200


def test_time_is_counted_in_milliseconds_and_one_current_comes_for_each() -> None:
    board = TwinBoard("", windings(), 24.0)
    assert board.advance(0) == []
    assert board.advance(17) == [(0.0, 0.0, 0.0)] * 17
    assert board.milliseconds == 17


@pytest.mark.parametrize("value", [0.0, -1.0, math.nan, math.inf])
def test_a_coil_without_a_positive_resistance_and_inductance_is_refused(value: float) -> None:
    with pytest.raises(ValueError, match="resistance"):
        Winding(value, 0.1)
    with pytest.raises(ValueError, match="inductance"):
        Winding(1.0, value)


@pytest.mark.parametrize("value", [-0.1, 65.1, math.nan, math.inf])
def test_a_supply_outside_the_bridges_range_is_refused(value: float) -> None:
    board = TwinBoard("", windings(), 24.0)
    with pytest.raises(ValueError, match="supply"):
        board.supply = value
    assert board.supply == 24.0
