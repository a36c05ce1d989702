"""Effects, comparisons, drift and intervals: against scipy where it has the same, else against what was planted."""

import math

import numpy as np
import pytest
from scipy import stats

from control.studies.analysis.comparison import Order, compare, pair
from control.studies.analysis.curves import panels
from control.studies.analysis.drift import drift
from control.studies.analysis.effects import effects
from control.studies.analysis.intervals import mean_interval, mean_of_means
from control.studies.analysis.screening import screening
from control.studies.analysis.sets import as_good_as_best, best, summarise
from tests.control.studies.planted import one_axis, planted

TILT, SWEEP, STEP = "gait.tilt_deg", "gait.sweep_deg", "gait.path_step_s"
GRID = {SWEEP: [20, 30], TILT: [20, 25, 30], STEP: [0.1, 0.3]}


def test_with_one_axis_the_analysis_of_variance_is_scipy_s() -> None:
    samples = one_axis([20.0, 25.0, 30.0], 10, lambda tilt: 0.01 * tilt, 0.05, 1)
    found = effects(samples)
    assert found is not None
    (tilt,) = found.effects
    assert tilt.p == pytest.approx(stats.f_oneway(*samples.groups()).pvalue, rel=1e-9)
    assert tilt.share.value + found.noise == pytest.approx(1.0)
    assert tilt.share.low < tilt.share.value < tilt.share.high


@pytest.mark.parametrize("repeats", [2, 10])
def test_the_interval_of_a_share_holds_the_true_one_as_often_as_it_says(full: bool, repeats: int) -> None:
    levels, seeds = [1.0, 2.0, 3.0, 4.0], 400 if full else 100
    between = float(np.var([0.5 * level for level in levels]))
    drawn = [effects(one_axis(levels, repeats, lambda at: 0.5 * at, 1.0, seed)) for seed in range(seeds)]
    held = sum(one is not None and one.effects[0].share.holds(between / (between + 1.0)) for one in drawn)
    assert held / seeds == pytest.approx(0.95, abs=0.07)


def test_runs_that_do_not_scatter_leave_nothing_unsure() -> None:
    samples = one_axis([10.0, 20.0, 30.0], 3, lambda tilt: 0.01 * tilt, 0.0, 0)
    found = effects(samples)
    assert found is not None
    assert found.effects[0].p == 0.0
    assert found.effects[0].share.low == pytest.approx(1.0)
    low, high = samples.of_set(0), samples.of_set(2)
    assert pair(low, high).order is Order.LOWER
    assert pair(low, low).order is Order.OPEN


def test_without_repeats_an_effect_has_neither_chance_nor_interval() -> None:
    found = effects(one_axis([10.0, 20.0, 30.0], 1, lambda tilt: 0.01 * tilt, 0.0, 0))
    assert found is not None
    assert math.isnan(found.effects[0].p)
    assert not found.effects[0].share.known


def test_planted_effects_and_an_interaction_are_found_and_no_other() -> None:
    samples = planted(
        GRID, 10,
        lambda v, rng: v[STEP] + 0.005 * v[TILT] + 0.1 * (v[SWEEP] == 30 and v[STEP] == 0.3)
        + 0.02 * rng.standard_normal(),
    )  # fmt: skip
    found = effects(samples)
    assert found is not None
    p = {one.axes: one.p for one in found.effects}
    assert max(p[(STEP,)], p[(TILT,)], p[(SWEEP,)], p[(SWEEP, STEP)]) < 1e-6
    assert min(p[(SWEEP, TILT)], p[(TILT, STEP)]) > 1e-3
    assert sum(one.share.value for one in found.effects) + found.noise == pytest.approx(1.0, abs=0.01)


def test_lost_runs_do_not_make_an_effect() -> None:
    """Half of the runs at one corner failed: the design is no longer balanced, the answer stays."""
    samples = planted(
        GRID, 12,
        lambda v, rng: None if v[TILT] == 20 and v[STEP] == 0.1 and rng.random() < 0.7
        else v[STEP] + 0.02 * rng.standard_normal(),
    )  # fmt: skip
    found = effects(samples)
    assert found is not None
    p = {one.axes: one.p for one in found.effects}
    assert p[(STEP,)] < 1e-6
    assert p[(TILT,)] > 1e-3


def test_of_scattered_points_a_bent_effect_is_seen_too() -> None:
    rng = np.random.default_rng(2)
    samples = one_axis(sorted(rng.uniform(10, 40, 60).tolist()), 1, lambda tilt: (tilt - 25.0) ** 2, 10.0, 2)
    assert samples.scattered
    (tilt,) = screening(samples)
    assert tilt.p < 1e-4
    assert abs(tilt.rank_correlation) < 0.4


def test_one_controller_lies_below_another_only_where_the_runs_say_so() -> None:
    samples = planted(
        {"controller": ["geometric", "gradient"], SWEEP: [20, 30]}, 20,
        lambda v, rng: 0.3 + 0.1 * (v["controller"] == "geometric" and v[SWEEP] == 20) + 0.02 * rng.standard_normal(),
    )  # fmt: skip
    found = {one.fixed[SWEEP]: one for one in compare(samples, "controller")}
    assert (found[20].one, found[20].other, found[20].order) == ("geometric", "gradient", Order.HIGHER)
    assert found[20].difference.holds(0.1)
    assert found[20].below < 0.05
    assert found[30].difference.holds(0.0)
    assert found[30].order is Order.OPEN


def test_single_runs_are_compared_without_an_interval() -> None:
    samples = planted({"controller": ["geometric", "gradient"]}, 1, lambda _, rng: float(rng.random()))
    (found,) = compare(samples, "controller")
    assert found.order is Order.OPEN
    assert not found.difference.known


def test_a_drift_over_the_order_is_noticed_and_a_shuffled_one_is_not() -> None:
    samples = one_axis([20.0, 25.0, 30.0], 20, lambda tilt: 0.01 * tilt, 0.01, 4)
    order = np.random.default_rng(1).permutation(60).tolist()
    steady = drift(samples, order)
    for place, index in enumerate(order):
        samples.value[index] += 0.1 * place / 59.0
    grown = drift(samples, order)
    assert steady is not None
    assert grown is not None
    assert not steady.noticed
    assert grown.noticed
    assert grown.slope.holds(0.1)


@pytest.mark.parametrize("repeats", [2, 10])
def test_a_drift_that_is_none_is_noticed_no_more_often_than_it_says(full: bool, repeats: int) -> None:
    """With two repeats, the runs less their set's mean are pairs of each other's mirror, half as many as they seem."""
    seeds = 1000 if full else 150
    chances = []
    for seed in range(seeds):
        samples = one_axis([float(level) for level in range(12)], repeats, lambda _: 0.0, 1.0, seed)
        found = drift(samples, np.random.default_rng(seed + seeds).permutation(len(samples.index)).tolist())
        assert found is not None
        chances.append(found.p)
    assert np.mean(np.array(chances) < 0.05) < 0.11


def test_the_drift_of_a_study_that_is_not_over_is_that_of_its_runs_so_far() -> None:
    samples = one_axis([20.0], 20, lambda _: 0.2, 1e-6, 4)
    samples.value[:] += np.linspace(0.0, 0.1, 20)
    found = drift(samples, range(200))
    assert found is not None
    assert found.slope.value == pytest.approx(0.1, rel=0.01)


def test_failed_runs_are_counted_and_in_no_mean() -> None:
    samples = planted(
        {TILT: [20, 25]}, 4, lambda v, rng: None if v[TILT] == 20 else 0.2 + 0.01 * rng.random()
    )
    failed, finished = summarise(samples)
    assert (failed.runs, failed.failed, finished.runs, finished.failed) == (0, 4, 4, 0)
    assert math.isnan(failed.mean.value)
    assert best((failed, finished)) is finished
    assert as_good_as_best((failed, finished)) == (finished,)


def test_a_mean_s_interval_is_student_s() -> None:
    values = np.random.default_rng(0).normal(size=7)
    ours, theirs = mean_interval(values), stats.ttest_1samp(values, 0.0).confidence_interval()
    assert (ours.low, ours.high) == pytest.approx((theirs.low, theirs.high))
    assert not mean_interval(values[:1]).known
    assert not mean_of_means([values, values[:1]]).known


def test_a_mean_over_other_axes_counts_every_set_alike() -> None:
    samples = planted(
        {TILT: [20, 25], STEP: [0.1, 0.3]}, 4,
        lambda v, rng: None if v[STEP] == 0.1 and rng.random() < 0.4 else v[STEP] + 0.001 * rng.random(),
    )  # fmt: skip
    (panel,) = panels(samples, TILT)
    assert all(mean.value == pytest.approx(0.2, abs=0.002) for mean in panel.curves[0].means)
