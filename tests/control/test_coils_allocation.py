"""From a command to a field to currents: the angles come out right and no current passes its limit."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from control.coils import CoilSet, command_field, currents_for, limit_currents
from control.model import PIVOT_A, PIVOT_B, Pose, opposite, pivot_point, wrap

COILS = CoilSet()
STRENGTH = 10e-3
TILT = math.radians(25.0)

on_the_plate = st.floats(-0.06, 0.06)
angles = st.floats(-10.0, 10.0)
pivots = st.sampled_from([PIVOT_A, PIVOT_B])
any_finite = st.floats(allow_nan=False, allow_infinity=False)
limits = st.tuples(*[st.floats(1e-3, 100.0)] * 3)


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


@given(st.tuples(any_finite, any_finite, any_finite), limits)
def test_no_finite_current_passes_its_limit(currents, limits):
    limited, _ = limit_currents(currents, limits)
    assert all(abs(current) <= limit for current, limit in zip(limited, limits, strict=True))


@given(st.tuples(*[st.floats(-1e6, 1e6)] * 3), limits)
def test_currents_beyond_a_limit_are_scaled_alike(currents, limits):
    limited, saturated = limit_currents(currents, limits)
    share = 1.0 / max(1.0, *(abs(i) / limit for i, limit in zip(currents, limits, strict=True)))
    assert limited == pytest.approx([share * i for i in currents], rel=1e-12, abs=1e-300)
    assert saturated == any(abs(i) > limit for i, limit in zip(currents, limits, strict=True))


@given(limits)
def test_currents_at_their_limits_pass_unchanged(limits):
    assert limit_currents(limits, limits) == (limits, False)
    assert limit_currents((0.0, 0.0, 0.0), limits) == ((0.0, 0.0, 0.0), False)


@pytest.mark.parametrize("coil", [0, 1, 2])
@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_a_current_that_is_not_finite_is_refused(coil, value):
    currents = [9.0, 9.0, 9.0]
    currents[coil] = value
    with pytest.raises(ValueError, match=f"coil {coil + 1} must be a finite number of A"):
        limit_currents((currents[0], currents[1], currents[2]), (8.0, 8.0, 8.0))


@pytest.mark.parametrize("limit", [0.0, -8.0, math.nan, math.inf])
def test_a_limit_that_limits_nothing_is_refused(limit):
    with pytest.raises(ValueError, match="limit of coil 2"):
        limit_currents((1.0, 1.0, 1.0), (8.0, limit, 8.0))
