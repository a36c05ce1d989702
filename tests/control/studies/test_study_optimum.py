"""The optimum along an axis: a planted one lies inside its interval, and what is not known is said."""

import math

import numpy as np
import pytest

from control.studies.analysis.joint import joint_optimum
from control.studies.analysis.optimum import Kind, Optimum, optimum
from control.studies.analysis.samples import samples
from control.studies.definition import StudyDefinition
from tests.control.studies.planted import one_axis, planted, planted_table

TILT = "gait.tilt_deg"
TILTS = [10.0, 15.0, 20.0, 25.0, 30.0, 35.0]


def bowl(at: float, bend: float = 0.001):
    return lambda tilt: 0.2 + bend * (tilt - at) ** 2


def found(levels: list[float], repeats: int, error, noise: float = 0.03, seed: int = 0) -> Optimum:
    one = optimum(one_axis(levels, repeats, error, noise, seed), TILT)
    assert one is not None
    return one


@pytest.mark.parametrize(("levels", "repeats"), [(TILTS, 10), (TILTS, 3), ([20.0, 25.0, 30.0], 10)])
def test_a_planted_optimum_lies_inside_its_interval_in_nine_of_ten_seeds(
    full: bool, levels: list[float], repeats: int
) -> None:
    seeds = 200 if full else 30
    optima = [found(levels, repeats, bowl(24.5), seed=seed) for seed in range(seeds)]
    assert sum(one.where.holds(24.5) for one in optima) >= 0.9 * seeds
    assert sum(one.value.low <= 0.2 <= one.value.high for one in optima) >= 0.85 * seeds


def test_more_runs_make_the_interval_narrower() -> None:
    few, many = (found(TILTS, repeats, bowl(21.3)).where for repeats in (5, 80))
    assert many.half_width < 0.6 * few.half_width


def test_an_optimum_at_the_end_of_what_was_tried_is_said_to_be_there() -> None:
    assert found(TILTS, 10, lambda tilt: 0.01 * tilt, 0.01).kind is Kind.LOWER_EDGE
    assert found(TILTS, 10, lambda tilt: 1.0 - 0.01 * tilt, 0.01).kind is Kind.UPPER_EDGE
    assert found(TILTS, 10, bowl(24.5), 0.01).kind is Kind.INSIDE


def test_where_nothing_changes_the_place_cannot_be_told() -> None:
    flat = [found(TILTS, 10, lambda _: 0.2, seed=seed).kind for seed in range(20)]
    assert flat.count(Kind.FLAT) >= 15


def test_repeats_that_do_not_differ_give_the_place_of_the_smooth_line() -> None:
    one = found(TILTS, 3, bowl(22.0), 0.0)
    assert one.kind is Kind.INSIDE
    assert one.where.value == pytest.approx(22.0, abs=0.5)
    assert one.where.low == one.where.high == one.where.value


def test_an_inner_optimum_whose_interval_reaches_an_end_is_told_from_a_sure_one() -> None:
    sure, unsure = (found(TILTS, repeats, bowl(at)) for repeats, at in ((40, 22.0), (3, 33.0)))
    assert not sure.open_ended
    assert unsure.open_ended


@pytest.mark.parametrize(("levels", "repeats"), [([20.0, 30.0], 10), (TILTS, 1)])
def test_too_few_levels_or_repeats_give_a_best_level_and_no_interval(
    levels: list[float], repeats: int
) -> None:
    one = found(levels, repeats, bowl(21.0, 0.01), 0.001)
    assert one.kind is Kind.UNKNOWN
    assert one.measured == 20.0
    assert not one.where.known


def test_a_set_without_runs_does_not_bend_the_mean_over_the_others() -> None:
    """The tilt 20 degrees was only measured at the quick path step; its higher errors are not the tilt's."""
    grid = planted(
        {TILT: [15, 20, 25, 30], "gait.path_step_s": [0.1, 0.3]}, 6,
        lambda v, rng: None if v[TILT] == 20 and v["gait.path_step_s"] == 0.1
        else 0.2 + v["gait.path_step_s"] + 0.002 * (v[TILT] - 21.0) ** 2 + 0.002 * rng.standard_normal(),
    )  # fmt: skip
    one = optimum(grid, TILT)
    assert one is not None
    assert one.where.value == pytest.approx(21.0, abs=0.5)


def test_words_have_no_optimum() -> None:
    grid = planted({"controller": ["geometric", "gradient"]}, 3, lambda _, rng: float(rng.random()))
    assert optimum(grid, "controller") is None


def test_nothing_measured_has_no_optimum() -> None:
    assert optimum(one_axis(TILTS, 3, lambda _: math.nan, 0.0, 0), TILT) is None
    assert np.isnan(one_axis(TILTS, 3, lambda _: math.nan, 0.0, 0).value).all()


def test_among_scattered_points_a_planted_optimum_lies_inside_its_intervals(full: bool) -> None:
    definition = StudyDefinition.from_json({
        "name": "cube", "design": "latin", "latin": {"sets": 40},
        "axes": [{"of": TILT, "from": 10, "to": 35}, {"of": "gait.sweep_deg", "from": 15, "to": 40}],
    })  # fmt: skip
    inside, seeds = 0, 10 if full else 3
    for seed in range(seeds):
        table = planted_table(
            definition,
            lambda v, rng: (
                (0.2 + 0.001 * (v[TILT] - 24.0) ** 2 + 0.001 * (v["gait.sweep_deg"] - 30.0) ** 2)
                * float(rng.normal(1.0, 0.05))
            ),
            seed,
        )
        one = joint_optimum(samples(table.rows, table.axes))
        assert one is not None
        inside += one.where[TILT].holds(24.0) and one.where["gait.sweep_deg"].holds(30.0)
        assert one.where[TILT].half_width < 8.0
    assert inside >= 0.6 * seeds
