"""The regulator's integers: 32 bits are enough for every allowed configuration, whatever is sensed."""

from __future__ import annotations

import random
from dataclasses import replace

import pytest
from board_bench import CALM, Bench
from hypothesis import given, settings
from hypothesis import strategies as st

from control.link import messages
from control.simulation.regulator import Regulator


class Int32(int):
    """An integer that refuses to leave 32 bits."""

    def _checked(self, value: int) -> Int32:
        if not -(2**31) <= value < 2**31:
            raise OverflowError(f"{value} does not fit an int32")
        return Int32(value)

    def __add__(self, other: int) -> Int32:
        return self._checked(int(self) + int(other))

    def __sub__(self, other: int) -> Int32:
        return self._checked(int(self) - int(other))

    def __mul__(self, other: int) -> Int32:
        return self._checked(int(self) * int(other))

    def __lshift__(self, other: int) -> Int32:
        return self._checked(int(self) << other)

    def __rshift__(self, other: int) -> Int32:
        return Int32(int(self) >> other)

    def __neg__(self) -> Int32:
        return self._checked(-int(self))

    def __floordiv__(self, other: int) -> Int32:
        return Int32(int(self) // int(other))

    def __and__(self, other: int) -> Int32:
        return Int32(int(self) & int(other))

    __radd__, __rmul__, __rand__ = __add__, __mul__, __and__


resistances = st.sampled_from((100, 1500, 4000, 10000)) | st.integers(100, 10000)
supplies = st.sampled_from((5000, 24000, 50000)) | st.integers(5000, 50000)


gains = st.sampled_from(messages.SENSE_GAINS) | st.integers(*messages.SENSE_GAINS)


@given(resistances, st.data(), supplies, st.integers(0, 2**32), st.sampled_from((100, 800)))
@settings(max_examples=120, deadline=None, derandomize=True)
def test_no_intermediate_leaves_32_bits(
    resistance: int, data: st.DataObject, supply: int, seed: int, steps: int
) -> None:
    least = max(300, (resistance + 1) // 2)
    inductance = data.draw(st.sampled_from((least, 16000)) | st.integers(least, 16000))
    source = random.Random(seed)
    regulator = Regulator(steps)
    regulator.configure(Int32(resistance), Int32(inductance))
    regulator.sense_with(Int32(data.draw(gains)), Int32(data.draw(gains)))
    for _ in range(60):
        regulator.supply_is(Int32(source.choice((0, supply, 65535))), Int32(supply))
        regulator.observe(Int32(source.choice((0, 1023, source.randrange(1024)))))
        target = source.choice((-12000, 0, 12000, source.randrange(-12000, 12001)))
        duty = regulator.regulate(Int32(target))
        assert -steps <= duty <= steps


@pytest.mark.parametrize("wanted", [40, 100, 333, 2500])
def test_a_coil_with_coarse_pwm_is_regulated_finely(wanted: int) -> None:
    """One of its 100 steps is 160 mA at rest; the remainder of a step is carried over."""
    allocation = (0, 0, 0, 0, 0, 0, 0, round(wanted / 10000 * 16384), 0)
    bench = Bench().driving(tilt=0, allocation=allocation)
    seen = []
    for _ in range(25):
        bench.send(replace(CALM, tilt=0, allocation=allocation))
        seen += [1e3 * z for _, _, z in bench.board.advance(16)]
    assert bench.telemetry.commanded[2] == pytest.approx(wanted, abs=1)
    assert sum(seen) / len(seen) == pytest.approx(wanted, abs=8)
    assert max(seen) - min(seen) < 40
