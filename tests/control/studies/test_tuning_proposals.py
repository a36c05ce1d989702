"""Proposals of an auto-tune, on errors whose best place is known."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from control.studies.tuning.error_model import ErrorModel
from control.studies.tuning.proposing import best_point, propose, spread_points
from control.studies.tuning.space import Lattice, Point, Range, Space, Words, point_of

TILT, SWEEP = Range("gait.tilt_deg", 10.0, 35.0), Range("gait.sweep_deg", 10.0, 40.0)
SPACE = Space((TILT, SWEEP))
MIXED = Space(
    (Words("controller", ("geometric", "gradient", "planner")), Lattice("gait.tilt_deg", (20, 25, 30)))
)
SCATTER = 0.15
"""Of a single run, as a share of its error: what the slip plant shows."""


def error_at(point: Point) -> float:
    """A bowl whose bottom, 0.2, lies at 22° and 18°."""
    values = dict(point)
    tilt, sweep = values["gait.tilt_deg"] - 22.0, values["gait.sweep_deg"] - 18.0
    return 0.2 + 0.3 * (tilt / 15.0) ** 2 + 0.1 * (sweep / 15.0) ** 2


def walked(points: tuple[Point, ...], rng: np.random.Generator) -> np.ndarray:
    return np.array([error_at(point) * np.exp(SCATTER * rng.normal()) for point in points])


@pytest.fixture(scope="module")
def bowl() -> tuple[tuple[Point, ...], ErrorModel]:
    points = spread_points(SPACE, 64, seed=1)
    return points, ErrorModel(SPACE.places(points), walked(points, np.random.default_rng(1)))


def test_the_model_tells_the_scatter_of_runs_from_what_the_axes_do(
    bowl: tuple[tuple[Point, ...], ErrorModel],
) -> None:
    points, model = bowl
    belief = model.believe(SPACE.places(points))
    truth = np.log([error_at(point) for point in points])
    assert model.scatter == pytest.approx(SCATTER, rel=0.35)
    assert np.abs(belief.mean - truth).max() < 3 * SCATTER
    off = (belief.mean - truth) / belief.deviation
    assert np.mean(np.abs(off) < 1.96) > 0.85


def test_the_best_point_is_where_the_bowl_is_lowest_and_not_the_luckiest_run(
    bowl: tuple[tuple[Point, ...], ErrorModel],
) -> None:
    points, model = bowl
    best = best_point(SPACE, model, points, seed=1)
    assert error_at(best) < 0.2 * 1.05


def test_points_that_are_tried_together_are_not_all_the_same(
    bowl: tuple[tuple[Point, ...], ErrorModel],
) -> None:
    points, model = bowl
    proposal = propose(SPACE, model, points, count=4, seed=1)
    assert len(set(proposal.points)) > 1
    assert 0.0 <= proposal.gain < 1.0


def test_the_same_runs_give_the_same_proposals(bowl: tuple[tuple[Point, ...], ErrorModel]) -> None:
    points, model = bowl
    again = ErrorModel(SPACE.places(points), walked(points, np.random.default_rng(1)))
    assert propose(SPACE, again, points, 4, seed=1) == propose(SPACE, model, points, 4, seed=1)


@pytest.mark.parametrize("errors", [[0.3], [0.3, 0.3], [0.3, 0.3, 0.3], [1e-9, 0.3, 1e9]])
def test_one_run_equal_runs_and_wild_runs_leave_something_to_propose(errors: list[float]) -> None:
    points = spread_points(MIXED, len(errors), seed=0)
    model = ErrorModel(MIXED.places(points), np.array(errors))
    assert len(propose(MIXED, model, points, 3, seed=0).points) == 3


def test_a_choice_between_words_and_a_lattice_are_learned_too() -> None:
    truth = {"geometric": 0.4, "gradient": 0.2, "planner": 0.3}
    points = spread_points(MIXED, 24, seed=2)
    errors = np.array(
        [truth[dict(p)["controller"]] * (1 + abs(dict(p)["gait.tilt_deg"] - 25) / 25) for p in points]
    )
    found = best_point(MIXED, ErrorModel(MIXED.places(points), errors), points, seed=2)
    assert dict(found) == {"controller": "gradient", "gait.tilt_deg": 25}


@given(count=st.integers(1, 40), seed=st.integers(0, 2**31))
def test_points_of_a_space_lie_on_its_axes(count: int, seed: int) -> None:
    points = spread_points(MIXED, count, seed)
    assert len(points) == count
    for point in points:
        assert dict(point)["controller"] in ("geometric", "gradient", "planner")
        assert dict(point)["gait.tilt_deg"] in (20, 25, 30)
    places = MIXED.places(points)
    assert places.shape == (count, MIXED.coordinates)
    assert ((places >= 0.0) & (places <= 1.0)).all()


@given(low=st.floats(-1e3, 1e3), width=st.floats(1e-3, 1e4), share=st.floats(0.0, 1.0))
def test_a_value_of_a_range_is_short_to_write_and_lies_inside(low: float, width: float, share: float) -> None:
    axis = Range("controller.gain", low, low + width)
    value = axis.value(share)
    assert low <= value <= low + width
    assert abs(axis.share(value) - share) <= 1 / 200 + 1e-6


@pytest.mark.parametrize("axis", MIXED.axes)
def test_the_share_of_a_value_gives_the_value(axis: Lattice | Words) -> None:
    for value in axis.marks(10):
        assert axis.value(axis.share(value)) == value


def test_equal_values_are_one_point_in_whatever_order() -> None:
    assert point_of({"b": 1, "a": 2.0}) == point_of({"a": 2, "b": 1.0})
