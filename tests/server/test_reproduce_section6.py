"""Section 6 of the paper: each statement is judged from the data, by intervals alone."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

from control.coils import PAPER_PAIRS, CoilSet
from control.simulation.gait_survey import Spread, SwitchFigures
from control.simulation.rigid.tilt_study import TiltPoint
from control.studies.analysis.distribution import describe
from control.studies.analysis.intervals import Interval
from control.studies.definition import StudyDefinition
from control.studies.table import StudyRow, StudyTable
from server.cli import app
from server.reports import drawing
from server.reports.experiments import (
    designs,
    minimum,
    rig_claims,
    scatter_claims,
    sweep_claims,
    tilt_claims,
)
from server.reports.experiments.carrying import carry_out
from server.reports.experiments.designs import DISTRIBUTIONS, PARAMETRIC, RIGID, TILTS, experiments
from server.reports.experiments.measured import Measured
from server.reports.experiments.part import part, widths
from server.reports.experiments.scatter_claims import scatter_of
from server.reports.experiments.truth import Truth, all_of, below, most_of
from server.reports.findings import Verdict
from server.reports.study.printed import PRINTED

YES, NO, OPEN = Verdict.REPRODUCED, Verdict.NOT_REPRODUCED, Verdict.NOT_COMPARABLE


def study(key, runs=None):
    return next(one for one in experiments(runs) if one.key == key)


def table(key, error, scatter=0.01, metric="normalized_mean_error", repeats=5):
    """Runs of a study as if `error` of their values were what they gave, with a relative scatter."""
    plan = study(key, repeats).definition.plan()
    rng = np.random.default_rng(1)
    rows = []
    for index in range(plan.total):
        run = plan.run(index)
        values = {axis.rpartition(".")[2]: value for axis, value in run.values.items()}
        value = error(values) * (1.0 + scatter * rng.standard_normal())
        rows.append(StudyRow(index, run.set, run.repeat, run.seed, "finished", run.values, {metric: value}))
    return StudyTable(plan.axes, rows)


def measured(key, error, **changes):
    return Measured.of(table(key, error, **changes), changes.get("metric", "normalized_mean_error"))


def bowl(best):
    """ME with its minimum at a tilt, dearer above than below."""
    return lambda v: 0.2 + (0.002 if v["tilt_deg"] > best else 0.001) * (v["tilt_deg"] - best) ** 2


@pytest.mark.parametrize(("best", "verdict"), [(24.5, YES), (15.0, NO), (60.0, NO)])
def test_a_minimum_over_the_tilt_is_reproduced_where_it_is_and_nowhere_else(best, verdict):
    tilts = measured(TILTS, bowl(best))
    found = tilt_claims.smallest("slip", tilts.only(plant="slip"), 10)
    assert found.verdict is verdict, found.ours
    assert "no prediction" in found.note


def test_a_minimum_that_the_scatter_hides_is_not_comparable_and_says_why():
    tilts = measured(TILTS, lambda v: 0.2 + 1e-6 * v["tilt_deg"], scatter=0.3)
    found = tilt_claims.smallest("slip", tilts.only(plant="slip"), 10)
    assert found.verdict is OPEN
    assert "do not tell" in found.note


def test_a_minimum_whose_interval_leaves_the_papers_place_is_not_called_reproduced():
    tilts = measured(TILTS, bowl(27.3), scatter=0.05)
    slip = tilts.only(plant="slip")
    best = slip.best("tilt", sweep=10, step=0.1)
    assert best is not None
    assert best.where.low < 27.0 < best.where.high
    assert tilt_claims.smallest("slip", slip, 10).verdict is OPEN


def test_tilts_without_runs_are_not_called_dearer():
    whole = measured(TILTS, bowl(15.0)).only(plant="slip", sweep=10)
    tilts = np.array(whole.samples.column("gait.tilt_deg"))[whole.samples.place]
    some = Measured(replace(whole.samples, value=np.where(tilts < 20.0, whole.samples.value, math.nan)))
    assert minimum.near(some, "tilt", 24.5, step=0.1) is Truth.OPEN


def test_a_plant_on_which_the_tilt_does_nothing_has_no_minimum():
    tilts = measured(TILTS, lambda v: 0.2 + 0.1 * v["path_step_s"], scatter=0.0)
    found = tilt_claims.smallest("noslip", tilts.only(plant="noslip"), 30)
    assert found.verdict is NO
    assert found.ours.count("no dependence on the tilt") == 3


@pytest.mark.parametrize(("best", "verdicts"), [(24.0, (YES, YES, YES)), (32.0, (NO, NO, NO))])
def test_the_three_tilts_are_judged_at_every_path_step(best, verdicts):
    found = tilt_claims.of_study(measured(PARAMETRIC, bowl(best)))
    assert tuple(one.verdict for one in found) == verdicts


@pytest.mark.parametrize(("growth", "verdict"), [(1.0, YES), (-0.5, NO)])
def test_growth_with_the_path_step_is_asked_of_every_set(growth, verdict):
    errors = measured(PARAMETRIC, lambda v: 0.5 + growth * v["path_step_s"])
    ends = measured(PARAMETRIC, lambda v: 5.0 + 10.0 * growth * v["path_step_s"], metric="end_error_mm")
    found = sweep_claims.of_path_step(errors, ends)
    assert [one.verdict for one in found] == [verdict, verdict]


def test_one_set_that_does_not_grow_is_counted_but_the_mean_over_all_sets_decides():
    def error(values):
        odd = (values["sweep_deg"], values["tilt_deg"], values["path_step_s"]) == (15, 25, 0.3)
        return 0.1 if odd else 0.5 + values["path_step_s"]

    errors = measured(PARAMETRIC, error)
    found = sweep_claims.of_path_step(errors, errors)[0]
    assert found.verdict is YES
    assert "yes in 41 of 42, no in 1" in found.ours
    growth = sweep_claims.growth(errors, 0.1, 0.2)
    assert growth.holds(0.1)
    assert growth.half_width < 0.01


APART = {20: 30.0, 25: 32.0, 30: 35.0}


@pytest.mark.parametrize(("best", "verdict"), [(APART, YES), (dict.fromkeys(APART, 15.0), NO)])
def test_the_best_sweep_is_judged_by_its_interval(best, verdict):
    found = measured(PARAMETRIC, lambda v: 0.2 + 0.0005 * (v["sweep_deg"] - best[v["tilt_deg"]]) ** 2)
    assert [one.verdict for one in sweep_claims.of_sweep(found)[1:]] == [verdict] * 3


def test_the_slope_over_the_sweep_is_that_of_the_data_with_its_interval():
    found = measured(PARAMETRIC, lambda v: 1.0 - 0.01 * v["sweep_deg"], scatter=0.05)
    slope = sweep_claims.slope(found)
    assert slope.holds(-0.1)
    assert sweep_claims.of_sweep(found)[0].verdict is YES


def weibull(rng, controller, tilt):
    return (0.5 if controller == "gradient" else 0.8) * rng.weibull(3.6) * (1.0 + 0.05 * (tilt - 25))


def scatter_with(draw):
    """Forty runs of each set."""
    rng, plan = np.random.default_rng(5), study(DISTRIBUTIONS, 40).definition.plan()
    rows = []
    for index in range(plan.total):
        run = plan.run(index)
        value = draw(rng, run.values["controller"], run.values["gait.tilt_deg"])
        metrics = {"normalized_mean_error": value, "steps": 70.0}
        rows.append(StudyRow(index, run.set, run.repeat, run.seed, "finished", run.values, metrics))
    one = StudyTable(plan.axes, rows)
    return scatter_of(Measured.of(one), Measured.of(one, "steps"))


@pytest.fixture(scope="module")
def weibulls():
    return scatter_with(weibull)


def verdict_of(found, words):
    return next(one.verdict for one in found if words in one.paper)


def test_a_weibull_scatter_is_found_to_be_one_and_its_sets_are_compared(weibulls):
    found = scatter_claims.of_scatter(weibulls)
    assert verdict_of(found, "more Weibull") is OPEN
    assert verdict_of(found, "moves the mean up") is YES
    assert verdict_of(found, "the peak of the curve") is YES
    assert verdict_of(found, "Ob has the smaller mean") is YES
    assert verdict_of(found, "a larger sweep") is OPEN


@pytest.mark.parametrize(("shape", "truth"), [(1.3, Truth.YES), (3.6, Truth.OPEN)])
def test_a_weibull_law_is_found_only_where_it_can_be_told_from_a_bell(shape, truth):
    law = describe(np.random.default_rng(2).weibull(shape, 200))
    assert scatter_claims.is_weibull(law, 0.01) is truth
    assert scatter_claims.is_weibull(describe(law.values[::40]), 0.01) is Truth.OPEN


def test_a_peak_is_at_the_mean_by_the_interval_of_the_shape():
    at = scatter_claims.peaks_at_mean
    assert at(Interval(3.6, 3.2, 4.0)) is Truth.YES
    assert at(Interval(1.3, 1.1, 1.5)) is Truth.NO
    assert at(Interval(2.5, 1.2, 4.0)) is Truth.OPEN
    assert at(Interval(3.6)) is Truth.OPEN
    drawn = np.random.default_rng(3).weibull(2.0, 200_000)
    off = (scatter_claims.mode_of(2.0, 1.0) - drawn.mean()) / drawn.std()
    assert scatter_claims.peak_off_mean(2.0) == pytest.approx(off, abs=0.01)


def test_a_scatter_of_two_heaps_is_not_called_weibull_and_a_worse_ob_is_not_called_better():
    def heaps(rng, controller, _):
        return (1.2 if controller == "gradient" else 1.0) * (
            0.2 if rng.random() < 0.5 else 0.9
        ) + 0.001 * rng.random()

    found = scatter_claims.of_scatter(scatter_with(heaps))
    assert verdict_of(found, "more Weibull") is NO
    assert verdict_of(found, "Ob has the smaller mean") is not YES


def test_the_papers_inconsistent_rows_are_named_and_never_judged(weibulls):
    found = scatter_claims.of_scatter(weibulls)
    printed = next(one for one in found if "2 of the 6 printed rows" in one.ours)
    assert printed.verdict is OPEN
    assert "Ob {25,25}" in printed.ours
    assert "Gb {30,30}" in printed.ours
    header, *rows = widths(weibulls)
    assert [row[-1] for row in rows].count("inconsistent") == 2
    assert len(rows) == 9
    assert {row[header.index("paper_variance")] for row in rows} >= {one.variance for one in PRINTED}


def test_truth_is_told_by_intervals_alone():
    low, high = np.array([1.0, 1.1, 0.9]), np.array([2.0, 2.1, 1.9])
    assert (below(low, high), below(high, low), below(low, low)) == (Truth.YES, Truth.NO, Truth.OPEN)
    assert below(np.array([1.0]), np.array([2.0])) is Truth.OPEN
    assert below(np.array([]), high) is Truth.OPEN
    assert below(np.full(3, 1.0), np.full(3, 2.0)) is Truth.YES
    assert all_of([Truth.YES, Truth.OPEN]) is Truth.OPEN
    assert all_of([Truth.OPEN, Truth.NO]) is Truth.NO
    assert all_of([]) is Truth.OPEN
    assert most_of([Truth.YES, Truth.NO]) is Truth.OPEN


def test_why_there_is_a_minimum_is_asked_of_the_rigid_plants_switches():
    def point(tilt, play, slip):
        none = Spread(0.0, 0.0)
        figures = SwitchFigures(
            play=Spread(play, 0.1 * play), out=none, forward=none, hop=none,
            displacement=Spread(slip, 0.1 * slip), tilt=none, advance=1.0,
        )  # fmt: skip
        return TiltPoint(2.6, 0.05, math.radians(tilt), figures)

    sticks = [point(10, 0.2, 1e-5), point(25, 0.02, 1e-5), point(35, 0.02, 3e-4)]
    assert tilt_claims.cause(sticks).verdict is YES
    assert tilt_claims.cause([replace(one, figures=sticks[1].figures) for one in sticks]).verdict is OPEN
    found = tilt_claims.by_magnet([*sticks, *(replace(one, ratio=7.0) for one in sticks)])
    weak = "lifts from 23° on, play 11.5° to 1.1°, slip of a pivot 0.01 mm to 0.30 mm"
    assert f"at Λ = 2.6 the free end {weak}" in found.ours
    assert "Λ = 7 the free end lifts from 8°" in found.ours
    assert found.verdict is OPEN


def test_the_papers_coils_do_not_make_a_uniform_field_and_large_ones_do():
    strength, tilt = rig_claims.nonuniformity(CoilSet())
    assert strength > 0.05
    assert math.degrees(tilt) == pytest.approx(19.0, abs=1.0)
    large = [replace(pair, diameter=4.0, separation=2.0) for pair in PAPER_PAIRS]
    strength, tilt = rig_claims.nonuniformity(CoilSet(large))
    assert strength < 0.01
    assert math.degrees(tilt) == pytest.approx(25.0, abs=0.1)


def test_the_rigid_study_is_the_study_of_the_tilts_on_another_plant():
    definition = designs.rigid(study(TILTS).definition)
    assert definition.plant.name == "rigid"
    assert definition.axis_names == ("gait.sweep_deg", "gait.tilt_deg")
    assert definition.duration_s == designs.RIGID_DURATION_S


def short(one, seconds=1.5):
    raw = {**one.definition.to_json(), "duration_s": seconds}
    return replace(one, definition=StudyDefinition.from_json(raw))


@pytest.fixture(scope="module")
def whole():
    """All studies of kinematic plants, with two runs of a set and the first seconds of an eight."""
    studies = [short(one) for one in experiments(2) if one.key != RIGID]
    told, kept = [], {}

    def keep(key, table):
        assert not any(done > sum(map(len, kept.values())) + len(table) for _, done, _ in told), "at once"
        kept[key] = table

    def watch(one, done, total):
        told.append((one.key, done, total))

    tables = carry_out(studies, jobs=1, watch=watch, keep=keep)
    assert kept == tables
    return studies, tables, told


def test_progress_counts_the_runs_of_all_studies(whole):
    _, tables, told = whole
    total = 2 * (63 + 9 + 132)
    assert told[-1] == (TILTS, total, total)
    assert sum(len(one) for one in tables.values()) == total
    assert [done for _, done, _ in told] == sorted(done for _, done, _ in told)


def test_a_smaller_report_is_whole_and_says_that_it_is_smaller(whole, monkeypatch):
    studies, tables, _ = whole
    monkeypatch.setattr(drawing, "DPI", 40)
    made = part(studies, tables)
    text = "".join(made.body)
    assert "126 runs, 2 instead of 10 of each set" in text
    assert "18 runs, 2 instead of 100 of each set" in text
    assert "fewer runs than the paper" in text
    assert "rigid plant is not in this report" in text
    assert len(made.findings) >= 25
    assert all(one.note for one in made.findings if one.verdict is OPEN)
    assert {one.name for one in made.pictures} >= {
        "tilt_at_10",
        "tilt_by_sweep",
        "scatter",
        "paths_controllers",
    }
    assert all(one.png.startswith(b"\x89PNG") for one in made.pictures)
    assert made.raw["section6_parametric.csv"] == tables[PARAMETRIC].csv()


@pytest.mark.parametrize("sections", ["4", "three", ","])
def test_a_section_that_there_is_none_of_is_wrong_usage(sections, tmp_path):
    answer = CliRunner().invoke(app, ["reproduce", "--sections", sections, "--out", str(tmp_path)])
    assert answer.exit_code == 2
    assert "3, 5, 6" in answer.stderr
