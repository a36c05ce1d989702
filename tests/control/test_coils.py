"""Laws of the coils' field and of its map over the plate."""

import math
import time
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from control.coils import MAP_MARGIN, PAPER_PAIRS, CoilPair, CoilSet

MU0 = 4e-7 * math.pi
COILS = CoilSet()
EDGE = COILS.workspace + MAP_MARGIN

on_the_map = st.floats(-EDGE, EDGE)
amperes = st.floats(-8.0, 8.0)


def axis_vector(pair: CoilPair) -> np.ndarray:
    return np.array([pair.axis == "x", pair.axis == "y", pair.axis == "z"], dtype=float)


@given(st.tuples(amperes, amperes, amperes), st.tuples(amperes, amperes, amperes), st.floats(-3.0, 3.0))
def test_the_field_is_linear_in_the_currents(first, second, factor):
    points = [(0.03, -0.02, 0.0), (0.1, 0.2, 0.15)]
    combined = np.add(first, np.multiply(factor, second))
    parts = COILS.field_at(points, first) + factor * COILS.field_at(points, second)
    assert np.allclose(COILS.field_at(points, combined), parts, rtol=0.0, atol=1e-15)


@pytest.mark.parametrize("column", [0, 1, 2])
def test_the_field_at_the_centre_is_that_of_two_loops_on_their_axis(column):
    pair = COILS.pairs[column]
    radius, half = 0.5 * pair.diameter, 0.5 * pair.separation
    on_axis = MU0 * pair.turns * radius**2 / (radius**2 + half**2) ** 1.5
    assert np.allclose(np.array(COILS.centre)[:, column], on_axis * axis_vector(pair), rtol=1e-9, atol=1e-12)


def test_eight_amperes_in_the_outer_coils_make_ten_millitesla_at_the_centre():
    assert COILS.local_field(0.0, 0.0, (8.0, 0.0, 0.0))[0] == pytest.approx(10e-3, rel=2e-3)


@pytest.mark.parametrize("column", [0, 1, 2])
def test_far_away_a_pair_is_a_dipole(column):
    pair = COILS.pairs[column]
    moment = 2.0 * pair.turns * math.pi * (0.5 * pair.diameter) ** 2 * axis_vector(pair)
    point = np.array([3.0, -4.0, 5.0])
    distance = np.linalg.norm(point)
    towards = point / distance
    dipole = MU0 / (4.0 * math.pi * distance**3) * (3.0 * towards * (moment @ towards) - moment)
    assert np.allclose(COILS.field_per_ampere([point])[0, :, column], dipole, rtol=0.01, atol=0.0)


@given(on_the_map, on_the_map)
def test_the_field_is_mirrored_about_both_axes(x, y):
    here, across_x, across_y = (COILS.plane_elements(*p) for p in ((x, y), (-x, y), (x, -y)))
    signs = np.array([1.0, -1.0, -1.0, 1.0, 1.0])
    assert np.allclose(across_x, signs * here, rtol=1e-9, atol=1e-14)
    assert np.allclose(across_y, signs * here, rtol=1e-9, atol=1e-14)


def test_the_map_is_within_a_thousandth_of_the_exact_field_up_to_its_edge():
    points = np.random.default_rng(1).uniform(-EDGE, EDGE, (4000, 3)) * (1.0, 1.0, 0.0)
    exact = COILS.field_per_ampere(points)
    mapped = np.array([COILS.per_ampere(x, y) for x, y, _ in points])
    size = np.linalg.norm(exact, axis=(1, 2), ord=2)
    assert (np.abs(mapped - exact).max(axis=(1, 2)) / size).max() < 1e-3


def test_on_the_plate_horizontal_and_vertical_fields_do_not_mix():
    points = np.random.default_rng(2).uniform(-EDGE, EDGE, (200, 3)) * (1.0, 1.0, 0.0)
    exact = COILS.field_per_ampere(points)
    assert np.abs(exact[:, 2, :2]).max() < 1e-15
    assert np.abs(exact[:, :2, 2]).max() < 1e-15


def test_beyond_the_map_its_edge_is_read():
    assert COILS.plane_elements(1.0, -math.pi) == COILS.plane_elements(EDGE, -EDGE)


@pytest.mark.parametrize("x", [math.nan, math.inf, -math.inf])
def test_a_position_that_is_not_finite_has_no_field(x):
    with pytest.raises(ValueError, match="finite position"):
        COILS.plane_elements(x, 0.0)


def test_the_field_as_a_vector_and_as_a_matrix_agree():
    currents = (3.0, -2.0, 5.0)
    here = COILS.local_field(0.041, -0.033, currents)
    assert here == pytest.approx(np.array(COILS.per_ampere(0.041, -0.033)) @ currents, rel=1e-12)
    assert here == pytest.approx(COILS.field_at([(0.041, -0.033, 0.0)], currents)[0], rel=1e-3)


def test_a_new_geometry_is_mapped_in_well_under_a_second():
    begin = time.perf_counter()
    CoilSet([replace(pair, turns=pair.turns + 1) for pair in PAPER_PAIRS])
    assert time.perf_counter() - begin < 1.0


def test_the_pairs_are_ordered_by_axis_whatever_order_they_come_in():
    assert CoilSet(PAPER_PAIRS[::-1]).pairs == PAPER_PAIRS
    assert CoilSet(PAPER_PAIRS[::-1]).centre == COILS.centre


def test_the_loops_of_a_pair_stand_at_half_its_separation_on_its_axis():
    assert PAPER_PAIRS[1].centres == ((0.0, -0.095, 0.0), (0.0, 0.095, 0.0))


@pytest.mark.parametrize("pairs", [PAPER_PAIRS[:2], (*PAPER_PAIRS[:2], PAPER_PAIRS[0]), ()])
def test_a_coil_set_without_one_pair_on_each_axis_is_refused(pairs):
    with pytest.raises(ValueError, match="one pair on each of the axes"):
        CoilSet(pairs)


@pytest.mark.parametrize("field", ["diameter", "separation", "turns", "resistance", "inductance"])
@pytest.mark.parametrize("value", [0.0, -1.0, math.nan, math.inf])
def test_a_pair_needs_finite_dimensions_above_zero(field, value):
    with pytest.raises(ValueError, match=field):
        replace(PAPER_PAIRS[0], **{field: value})


def test_a_pair_on_no_axis_is_refused():
    with pytest.raises(ValueError, match="one of x, y, z"):
        replace(PAPER_PAIRS[0], axis="w")


def test_coils_that_cannot_make_every_field_over_the_workspace_are_refused():
    with pytest.raises(ValueError, match="condition number"):
        CoilSet(PAPER_PAIRS, workspace=0.15)


@pytest.mark.parametrize("workspace", [0.0, math.nan, -0.06])
def test_a_workspace_needs_a_size(workspace):
    with pytest.raises(ValueError, match="workspace half-size"):
        CoilSet(PAPER_PAIRS, workspace)
