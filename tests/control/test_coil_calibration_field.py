"""The least squares behind `pivotrig calibrate coils`: what readings tell, and which are refused."""

import functools
import math
import random
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from control.axes import AXES
from control.calibration.field_gain import BadReadings, Reading, fit_field
from control.coils import PAPER_PAIRS, field_per_ampere

patient = settings(deadline=None)
"""What an example takes on a busy computer is no matter here."""

ROOM = (18e-6, 4e-6, -44e-6)
CURRENTS = (2.0, -2.0, 1.0, -1.0)
gains_ = st.tuples(*[st.floats(0.55, 1.9)] * 3)


@functools.cache
def strength(point):
    """Field per ampere of each pair there, T/A: (component, pair)."""
    return field_per_ampere(PAPER_PAIRS, np.array([point]))[0]


def reading(coil, current, component, gain=1.0, noise=0.0, point=(0.003, -0.002, 0.001)):
    true = (
        gain * strength(point)[AXES.index(component), AXES.index(coil)] * current
        + ROOM[AXES.index(component)]
    )
    return Reading(coil, current, point, component, true + noise)


def along_own_axis(gains, noise=0.0, seed=1, coils=AXES):
    chance = random.Random(seed)
    return [
        reading(coil, current, coil, gains[AXES.index(coil)], chance.gauss(0.0, noise))
        for coil in coils
        for current in CURRENTS
    ]


@patient
@given(gains_)
def test_readings_without_noise_give_the_gains_and_the_rooms_own_field(gains):
    found = fit_field(PAPER_PAIRS, along_own_axis(gains))
    assert [found.pairs[axis].gain for axis in AXES] == pytest.approx(gains, rel=1e-9)
    assert found.ambient == pytest.approx(ROOM, abs=1e-12)
    assert found.worst_residual < 1e-9


@patient
@given(gains_)
def test_a_gain_that_the_rig_file_has_already_makes_no_difference(gains):
    before = [replace(pair, gain=1.3) for pair in PAPER_PAIRS]
    found = fit_field(before, along_own_axis(gains))
    assert [found.pairs[axis].gain for axis in AXES] == pytest.approx(gains, rel=1e-9)


def test_all_three_components_at_any_points_serve_as_well():
    points = [(0.02, 0.03, 0.0), (-0.04, 0.01, 0.01)]
    readings = [
        reading("y", current, component, 1.2, point=point)
        for current in (2.0, -2.0)
        for point in points
        for component in AXES
    ]
    assert fit_field(PAPER_PAIRS, readings).pairs["y"].gain == pytest.approx(1.2, rel=1e-9)


def test_the_standard_error_says_how_far_the_gain_is_off(full):
    misses = []
    for seed in range(200 if full else 40):
        pair = fit_field(PAPER_PAIRS, along_own_axis((1.1, 0.9, 1.0), 2e-5, seed)).pairs["x"]
        misses.append((pair.gain - 1.1) / pair.standard_error)
    assert np.std(misses) == pytest.approx(math.sqrt(6.0 / 4.0), abs=0.35), (
        "Student's t of 6 degrees of freedom"
    )


def test_a_pair_that_was_not_measured_has_no_gain():
    assert set(fit_field(PAPER_PAIRS, along_own_axis((1.0, 1.0, 1.0), coils=("x", "z"))).pairs) == {"x", "z"}


def test_swapped_leads_are_named():
    readings = along_own_axis((1.0, -1.0, 1.0))
    with pytest.raises(BadReadings, match=r"the y coils' field has the wrong sign .* leads are swapped"):
        fit_field(PAPER_PAIRS, readings)


def test_a_probe_held_the_wrong_way_round_is_told_from_swapped_leads():
    with pytest.raises(BadReadings, match="every field has the wrong sign"):
        fit_field(PAPER_PAIRS, along_own_axis((-1.0, -1.0, -1.0)))


@pytest.mark.parametrize("gain", [0.0, 0.49, 2.01, 1000.0])
def test_a_gain_that_no_winding_has_is_refused(gain):
    with pytest.raises(BadReadings, match="times the field that their geometry says"):
        fit_field(PAPER_PAIRS, along_own_axis((gain, 1.0, 1.0)))


def test_too_few_readings_are_refused():
    with pytest.raises(BadReadings, match="the z coils have 3 readings, 4 are needed"):
        fit_field(PAPER_PAIRS, along_own_axis((1.0, 1.0, 1.0))[:-1])
    with pytest.raises(BadReadings, match="there are no readings"):
        fit_field(PAPER_PAIRS, [])


def test_one_direction_of_current_does_not_tell_coil_from_room():
    readings = [reading("x", current, "x") for current in (1.0, 1.5, 2.0, 2.5)]
    with pytest.raises(BadReadings, match="one direction of current only"):
        fit_field(PAPER_PAIRS, readings)


def test_a_probe_across_the_field_is_refused():
    readings = [reading("x", current, "z") for current in CURRENTS]
    with pytest.raises(BadReadings, match="measure the x component near their centre"):
        fit_field(PAPER_PAIRS, readings)


def test_a_slip_of_the_pen_is_found_and_shown():
    readings = along_own_axis((1.0, 1.0, 1.0))
    readings[5] = replace(readings[5], field=readings[5].field * 0.1)
    with pytest.raises(BadReadings, match=r"the y coils scatter by .* at -2 A \(y component\)"):
        fit_field(PAPER_PAIRS, readings)


@pytest.mark.parametrize(
    "change", [{"current": math.nan}, {"field": math.inf}, {"point": (0.0, math.nan, 0.0)}]
)
def test_a_reading_that_is_not_finite_is_refused(change):
    with pytest.raises(BadReadings, match="must be finite"):
        replace(reading("x", 1.0, "x"), **change)


def test_a_reading_of_a_coil_that_there_is_not_is_refused():
    with pytest.raises(BadReadings, match="x, y or z"):
        Reading("w", 1.0, (0.0, 0.0, 0.0), "x", 1e-3)  # type: ignore[arg-type]
