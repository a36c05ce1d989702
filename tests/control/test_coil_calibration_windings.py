"""Resistances by current sense, and the sense by an ammeter."""

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from control.axes import AXES, Axis
from control.calibration.windings import (
    RESISTANCE_TOLERANCE,
    AmmeterReading,
    BadAmmeter,
    SenseGains,
    SteadyCoil,
    calibrate_sense,
    check_windings,
)
from control.coils import PAPER_PAIRS

GAINS: dict[Axis, SenseGains] = dict.fromkeys(AXES, (0.0349, 0.0349))


def steady(axis, resistance, currents=(1.0, -1.0, 2.0, -2.0)):
    return [SteadyCoil(axis, current, current, resistance * current) for current in currents]


def complaint(axis, resistance):
    (check,) = check_windings(PAPER_PAIRS, steady(axis, resistance))
    assert check.resistance == pytest.approx(resistance)
    return check.complaint


@pytest.mark.parametrize("pair", PAPER_PAIRS, ids=lambda pair: pair.axis)
def test_a_resistance_within_its_tolerance_is_no_complaint(pair):
    for share in (-RESISTANCE_TOLERANCE + 1e-6, 0.0, RESISTANCE_TOLERANCE - 1e-6):
        assert complaint(pair.axis, pair.resistance * (1.0 + share)) == ""
    for share in (-RESISTANCE_TOLERANCE - 1e-6, RESISTANCE_TOLERANCE + 1e-6):
        assert complaint(pair.axis, pair.resistance * (1.0 + share)).startswith(f"the {pair.axis} coils have")


def test_exchanged_coils_are_recognised_by_their_resistance():
    assert "what the y coils have" in complaint("x", PAPER_PAIRS[1].resistance)
    assert "what the x coils have" in complaint("z", PAPER_PAIRS[0].resistance)


def test_a_hot_winding_and_a_shorted_one_have_causes_of_their_own():
    assert "a hot winding" in complaint("x", 3.2)
    assert "turns are shorted" in complaint("x", 1.2)


@pytest.mark.parametrize("sensed", [0.0, 0.05])
def test_a_coil_that_carries_nothing_has_an_open_lead(sensed):
    (check,) = check_windings(PAPER_PAIRS, [SteadyCoil("y", 1.0, sensed, 20.0)])
    assert math.isinf(check.resistance)
    assert "the y coils carry no current" in check.complaint
    assert "an open lead" in check.complaint


def test_only_what_was_measured_is_judged():
    assert [check.coil for check in check_windings(PAPER_PAIRS, steady("z", 1.5))] == ["z"]


@given(st.floats(0.75, 1.25), st.floats(0.75, 1.25))
def test_the_sense_takes_the_ammeters_scale_for_each_direction_by_itself(forward, reverse):
    readings = [AmmeterReading("x", sensed, forward * sensed) for sensed in (1.0, 2.0)]
    readings += [AmmeterReading("x", -sensed, -reverse * sensed) for sensed in (1.0, 2.0)]
    found = calibrate_sense(GAINS, readings)
    assert found["x"] == pytest.approx((0.0349 * forward, 0.0349 * reverse))
    assert found["y"] == found["z"] == GAINS["y"]


@pytest.mark.parametrize(
    ("sensed", "ammeter", "complaint"),
    [
        (0.4, 0.4, "use a larger current"),
        (math.nan, 1.0, "use a larger current"),
        (2.0, -2.0, "the other direction"),
        (2.0, 0.2, "the ammeter's range"),
        (2.0, math.nan, "the ammeter's range"),
    ],
)
def test_ammeter_readings_that_make_no_sense_are_refused(sensed, ammeter, complaint):
    with pytest.raises(BadAmmeter, match=complaint):
        calibrate_sense(GAINS, [AmmeterReading("y", sensed, ammeter)])


def test_a_check_says_how_far_the_resistance_is_off():
    (check,) = check_windings([replace(PAPER_PAIRS[0], resistance=2.0)], steady("x", 2.2))
    assert check.deviation == pytest.approx(0.1)
