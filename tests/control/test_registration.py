"""Laws of the registration: the same coils, seen from a camera that stands elsewhere."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from control.coils import PAPER_PAIRS, CoilSet, command_field, currents_for, field_per_ampere
from control.model import PIVOT_A, Pose, wrap
from control.registration import Registration
from control.simulation.plants import PlantChoice, build_plant

patient = settings(deadline=None)
"""What an example takes on a busy computer is no matter here."""

PLAIN = CoilSet()
MOVED = Registration(x=0.007, y=-0.004, rotation=math.radians(17.0))
COILS = CoilSet(PAPER_PAIRS, 0.06, MOVED)

on_the_plate = st.floats(-0.05, 0.05)
angles = st.floats(-10.0, 10.0)
amperes = st.floats(-8.0, 8.0)


def turned(vector, angle):
    c, s = math.cos(angle), math.sin(angle)
    return np.array([c * vector[0] - s * vector[1], s * vector[0] + c * vector[1], vector[2]])


def test_frames_that_coincide_leave_every_figure_as_it_was_to_the_last_digit():
    for same in (CoilSet(registration=Registration()), CoilSet(registration=Registration(rotation=-0.0))):
        for x, y in ((0.0, 0.0), (0.0123, -0.0456), (0.06, 0.06)):
            assert same.local_allocation(x, y) == PLAIN.local_allocation(x, y)
            assert same.local_field(x, y, (1.0, -2.0, 3.0)) == PLAIN.local_field(x, y, (1.0, -2.0, 3.0))
        assert same.centre_allocation() == PLAIN.centre_allocation()


def test_a_gain_of_one_leaves_every_figure_as_it_was_to_the_last_digit():
    same = CoilSet([replace(pair, gain=1.0) for pair in PAPER_PAIRS])
    assert same.local_allocation(0.0123, -0.0456) == PLAIN.local_allocation(0.0123, -0.0456)


@patient
@given(st.floats(0.2, 5.0), st.floats(0.2, 5.0), st.floats(0.2, 5.0))
def test_a_gain_scales_its_own_pair_and_no_other(x, y, z):
    pairs = [replace(pair, gain=gain) for pair, gain in zip(PAPER_PAIRS, (x, y, z), strict=True)]
    points = [(0.01, 0.02, 0.0), (-0.03, 0.05, 0.01)]
    scaled = field_per_ampere(pairs, np.array(points))
    assert np.allclose(scaled, PLAIN.field_per_ampere(points) * np.array([x, y, z]), rtol=1e-12, atol=0.0)


@patient
@given(on_the_plate, on_the_plate, st.tuples(amperes, amperes, amperes))
def test_the_field_turns_and_moves_with_the_coils(x, y, currents):
    """K(p) = R K_coils(R^T (p - o))."""
    cx, cy, _ = turned((x - MOVED.x, y - MOVED.y, 0.0), -MOVED.rotation)
    expected = turned(PLAIN.field_at([(cx, cy, 0.0)], currents)[0], MOVED.rotation)
    assert COILS.field_at([(x, y, 0.0)], currents)[0] == pytest.approx(expected, abs=1e-15)
    assert COILS.local_field(x, y, currents) == pytest.approx(expected, abs=2e-5 * 8.0e-2)


@patient
@given(on_the_plate, on_the_plate, on_the_plate)
def test_a_point_comes_back_from_the_coils_frame(x, y, z):
    points = np.array([(x, y, z), (0.01, 0.02, 0.03)])
    assert MOVED.to_workspace(MOVED.to_coils(points)) == pytest.approx(points, abs=1e-15)


@patient
@given(on_the_plate, on_the_plate, angles)
def test_the_local_allocation_makes_the_very_field_that_is_asked_in_the_workspace(x, y, heading):
    wanted = command_field(PIVOT_A, heading, 0.4, 0.01)
    made = COILS.local_field(x, y, currents_for(COILS.local_allocation(x, y), wanted))
    assert made == pytest.approx(wanted, rel=1e-12, abs=1e-17)


@patient
@given(on_the_plate, on_the_plate, angles)
def test_a_reversed_magnet_gets_every_field_the_other_way_round(x, y, heading):
    coils = CoilSet(registration=Registration(magnet_reversed=True))
    wanted = np.array(command_field(PIVOT_A, heading, 0.4, 0.01))
    made = coils.local_field(x, y, currents_for(coils.local_allocation(x, y), tuple(wanted)))
    assert made == pytest.approx(-wanted, rel=1e-12, abs=1e-17)
    assert np.array(coils.centre_allocation()) == pytest.approx(-np.array(PLAIN.centre_allocation()))


def test_the_centre_allocation_is_that_of_the_coils_centre():
    at_centre = COILS.local_allocation(MOVED.x, MOVED.y)
    assert COILS.centre_allocation() == at_centre
    assert np.array(COILS.centre) @ np.array(at_centre) == pytest.approx(np.eye(3), abs=1e-12)


def heading_error(believed: Registration, true: Registration, x: float, y: float) -> float:
    """How far a robot without play lies off the commanded heading, at the worst heading, rad."""
    host, world = CoilSet(registration=believed), CoilSet(registration=true)
    worst = 0.0
    for heading in np.linspace(0.0, 2.0 * math.pi, 12, endpoint=False):
        currents = currents_for(host.local_allocation(x, y), command_field(PIVOT_A, heading, 0.4, 0.01))
        plant = build_plant(PlantChoice("noslip"), 0.01, Pose(x, y, heading))
        sign = -1.0 if true.magnet_reversed else 1.0
        bx, by, bz = world.local_field(x, y, currents)
        for _ in range(200):
            plant.step((sign * bx, sign * by, sign * bz), 1e-3)
        worst = max(worst, abs(wrap(plant.pose.heading - heading)))
    return worst


@pytest.mark.parametrize("reversed_", [False, True])
def test_only_the_true_registration_brings_the_robot_to_the_commanded_heading(reversed_):
    true = replace(MOVED, magnet_reversed=reversed_)
    assert heading_error(true, true, 0.04, -0.045) < 1e-6
    assert heading_error(replace(true, rotation=0.0), true, 0.0, 0.0) == pytest.approx(
        MOVED.rotation, abs=0.02
    )
    assert heading_error(replace(true, x=0.0, y=0.0), true, 0.04, -0.045) > math.radians(0.3)


@pytest.mark.parametrize("name", ["x", "y", "rotation"])
@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_a_registration_that_is_not_finite_is_refused(name, value):
    with pytest.raises(ValueError, match=f"{name} must be a finite number"):
        Registration(**{name: value})


@pytest.mark.parametrize("gain", [0.0, -1.0, math.nan, math.inf])
def test_a_pair_whose_gain_is_no_positive_number_is_refused(gain):
    with pytest.raises(ValueError, match="field gain"):
        replace(PAPER_PAIRS[0], gain=gain)
