"""From a command to a field to currents: the angles come out right."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from control.coils import CoilSet, command_field, currents_for
from control.model import PIVOT_A, PIVOT_B, Pose, opposite, pivot_point, wrap

COILS = CoilSet()
STRENGTH = 10e-3
TILT = math.radians(25.0)

on_the_plate = st.floats(-0.06, 0.06)
angles = st.floats(-10.0, 10.0)
pivots = st.sampled_from([PIVOT_A, PIVOT_B])


def heading_of(field) -> float:
    return math.atan2(-field[0], field[1])


def elevation_of(field) -> float:
    return math.atan2(field[2], math.hypot(field[0], field[1]))


@given(pivots, angles, st.floats(0.0, math.pi / 3), st.floats(1e-4, 0.02))
def test_a_command_is_a_field_of_its_strength_heading_and_tilt(pivot, heading, tilt, strength):
    field = command_field(pivot, heading, tilt, strength)
    assert math.hypot(*field) == pytest.approx(strength, rel=1e-12)
    assert abs(wrap(heading_of(field) - heading)) < 1e-9
    assert elevation_of(field) == pytest.approx(-pivot * tilt, abs=1e-12)


@given(pivots, angles)
def test_the_field_points_from_the_raised_end_down_into_the_pressed_one_on_the_north_side(pivot, heading):
    field = np.array(command_field(pivot, heading, TILT, STRENGTH))
    pose = Pose(0.0, 0.0, heading)
    pressed = np.array(pivot_point(pose, pivot, 0.01))
    raised = np.array(pivot_point(pose, opposite(pivot), 0.01))
    assert field[:2] @ (pressed - raised) * pivot > 0.0
    assert field[2] * pivot < 0.0


@given(on_the_plate, on_the_plate, pivots, angles)
def test_the_local_allocation_makes_the_very_field_that_is_asked(x, y, pivot, heading):
    wanted = command_field(pivot, heading, TILT, STRENGTH)
    made = COILS.local_field(x, y, currents_for(COILS.local_allocation(x, y), wanted))
    assert made == pytest.approx(wanted, rel=1e-12, abs=1e-17)


def test_both_allocations_agree_at_the_centre():
    assert COILS.local_allocation(0.0, 0.0) == COILS.centre_allocation()
    assert np.allclose(np.array(COILS.centre) @ COILS.centre_allocation(), np.eye(3), atol=1e-12)


def test_the_centre_allocation_loses_tilt_and_heading_at_the_corner_as_the_paper_rig_does():
    headings = np.linspace(-math.pi, math.pi, 181)
    wanted = [command_field(PIVOT_A, heading, TILT, STRENGTH) for heading in headings]
    made = [COILS.local_field(0.06, 0.06, currents_for(COILS.centre_allocation(), field)) for field in wanted]
    tilts = np.degrees([-elevation_of(field) for field in made])
    errors = np.degrees([abs(wrap(heading_of(field) - h)) for field, h in zip(made, headings, strict=True)])
    assert round(tilts.min()) == 19
    assert round(tilts.max()) == 20
    assert errors.max() == pytest.approx(2.8, abs=0.05)
