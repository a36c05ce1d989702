"""The plan of an auto-tune: what comes next follows from the definition and the rows, and from nothing else."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from control.metrics import Metrics
from control.studies.definition import StudyDefinition
from control.studies.plan import PlannedRun
from control.studies.table import StudyRow, StudyTable
from control.studies.tuning import answer, learned_surface

Rows = dict[int, StudyRow]
Carry = Callable[[PlannedRun], StudyRow]


def definition(budget: int = 30, enough_percent: float = 0.0, **more: Any) -> StudyDefinition:
    axes = [{"of": "gait.sweep_deg", "from": 10, "to": 40}, {"of": "gait.tilt_deg", "from": 10, "to": 35}]
    tune = {"budget": budget, "first": 8, "at_once": 4, "confirm": 5, "enough_percent": enough_percent}
    raw = {"name": "Best gait", "design": "tune", "seed": 3, "axes": axes, "tune": tune}
    return StudyDefinition.from_json(raw | more)


def error_at(values: Mapping[str, Any]) -> float:
    """Of the mean, over the length: smallest, 0.2, at a tilt of 22° and a sweep of 18°."""
    tilt, sweep = values["gait.tilt_deg"] - 22.0, values["gait.sweep_deg"] - 18.0
    return 0.2 + 0.3 * (tilt / 15.0) ** 2 + 0.1 * (sweep / 15.0) ** 2


def walked(run: PlannedRun) -> StudyRow:
    """The error of its place, with a scatter that is the run's own."""
    error = error_at(run.values) * float(np.exp(0.1 * np.random.default_rng(run.seed).normal()))
    return StudyRow.finished(run, Metrics(0.01 * error, error, 0.0, 0.0, 0.0, 0.0, 0.0, 0, 0, 0, 0))


class Counted(Rows):
    """How often a row was read: a study's rows are on the disk."""

    read = 0

    def __getitem__(self, index: int) -> StudyRow:
        self.read += 1
        return super().__getitem__(index)


def not_walked(row: StudyRow) -> StudyRow:
    return replace(row, state="failed", metrics={})


def lost(run: PlannedRun) -> StudyRow:
    return StudyRow.failed(run, "the robot would leave the workspace")


def carried_out(study: StudyDefinition, carry: Carry = walked, done: Rows | None = None) -> Rows:
    plan, rows = study.plan(), dict(done or {})
    while coming := plan.next(rows):
        runs = [plan.run(index, rows) for index in coming]
        rows |= {run.index: carry(run) for run in runs}
    return rows


@pytest.fixture(scope="module")
def tuned() -> Rows:
    return carried_out(definition())


def table(rows: Rows) -> bytes:
    return StudyTable(("gait.sweep_deg", "gait.tilt_deg"), rows.values()).csv()


def test_a_tuning_takes_its_budget_and_numbers_its_runs_without_a_gap(tuned: Rows) -> None:
    assert sorted(tuned) == list(range(30))
    assert definition().plan().next(tuned) == []


def test_the_last_runs_are_all_at_one_point_and_that_is_the_answer(tuned: Rows) -> None:
    last = [tuned[index] for index in range(25, 30)]
    found = answer(definition(), tuned)
    assert found is not None
    assert all(row.values == found.values for row in last)
    assert found.measured is not None
    assert found.measured.mean == pytest.approx(np.mean([row.metric(found.metric) for row in last]))
    assert found.runs == 5
    assert error_at(found.values) < 0.2 * 1.1


def test_an_answer_says_how_many_runs_are_still_to_confirm_it(tuned: Rows) -> None:
    for kept, left in ((12, 5), (27, 3), (30, 0)):
        found = answer(definition(), {index: tuned[index] for index in range(kept)})
        assert found is not None
        assert (found.left, found.runs) == (left, 5 - left)
    unconfirmed = answer(definition(), tuned | {index: not_walked(tuned[index]) for index in range(25, 30)})
    assert unconfirmed is not None
    assert (unconfirmed.measured, unconfirmed.left) == (None, 0)


def test_what_is_enough_is_found_by_reading_each_row_once(tuned: Rows) -> None:
    rows = Counted(tuned)
    definition(enough_percent=1e-9).plan().next(rows)
    assert rows.read <= len(rows)


def test_the_interval_of_the_answer_holds_what_is_true_of_its_point(tuned: Rows) -> None:
    found = answer(definition(), tuned)
    assert found is not None
    assert found.measured is not None
    for interval in (found.expected, found.measured):
        assert interval.low is not None
        assert interval.high is not None
        assert interval.low < error_at(found.values) * np.exp(0.1**2 / 2) < interval.high


def test_a_tuning_that_was_interrupted_anywhere_ends_as_the_one_that_was_not(tuned: Rows, full: bool) -> None:
    for kept in (0, 5, 8, 14, 20, 26) if full else (5, 14, 26):
        part = {index: tuned[index] for index in range(kept)}
        assert table(carried_out(definition(), done=part)) == table(tuned)


def test_the_order_in_which_runs_come_back_has_no_say(tuned: Rows) -> None:
    plan, rows, shuffle = definition().plan(), {}, random.Random(5)
    while coming := list(plan.next(rows)):
        shuffle.shuffle(coming)
        for index in coming[:2]:
            rows[index] = walked(plan.run(index, rows))
    assert table(rows) == table(tuned)


def test_a_run_that_is_done_is_planned_as_it_was_done(tuned: Rows) -> None:
    plan = definition().plan()
    for index in (0, 13, 29):
        run = plan.run(index, tuned)
        assert (run.values, run.set, run.repeat) == (
            tuned[index].values,
            tuned[index].set,
            tuned[index].repeat,
        )


def test_a_run_that_cannot_be_known_yet_is_an_error() -> None:
    with pytest.raises(IndexError, match="when the runs before it are done"):
        definition().plan().run(8, {})


def test_equal_points_are_one_set_and_repeats_count_on(tuned: Rows) -> None:
    sets: dict[int, Any] = {}
    for row in StudyTable(("gait.sweep_deg", "gait.tilt_deg"), tuned.values()).rows:
        assert sets.setdefault(row.set, row.values) == row.values
    assert len({tuple(values.items()) for values in sets.values()}) == len(sets)
    for number in sets:
        repeats = [row.repeat for index, row in sorted(tuned.items()) if row.set == number]
        assert repeats == list(range(len(repeats)))


def test_every_point_is_repeated_as_often_as_was_asked_for_each_in_its_turn() -> None:
    study = definition(repeats=2, budget=29)
    plan = study.plan()
    first = [plan.run(index, {}) for index in plan.next({})]
    assert [run.set for run in first] == [*range(8), *range(8)]
    assert [run.repeat for run in first] == [0] * 8 + [1] * 8


def test_a_place_where_runs_fail_is_avoided() -> None:
    def carry(run: PlannedRun) -> StudyRow:
        return lost(run) if run.values["gait.tilt_deg"] < 24.0 else walked(run)

    rows = carried_out(definition(), carry)
    found = answer(definition(), rows)
    assert found is not None
    assert 24.0 <= found.values["gait.tilt_deg"] < 28.0
    assert sum(row.state == "failed" for index, row in rows.items() if index >= 8) < 11


def test_with_nothing_but_failures_it_looks_elsewhere_and_gives_no_answer() -> None:
    rows = carried_out(definition(), lost)
    assert len({tuple(row.values.items()) for row in rows.values()}) > 20
    assert answer(definition(), rows) is None
    assert learned_surface(definition(), rows) is None


def test_a_search_that_expects_little_more_ends_before_its_budget() -> None:
    rows = carried_out(definition(budget=80, enough_percent=2.0))
    assert 13 <= len(rows) < 60
    assert len({row.set for row in list(rows.values())[-5:]}) == 1


def test_what_was_learned_is_drawn_over_the_axes_with_its_uncertainty(tuned: Rows) -> None:
    surface = learned_surface(definition(), tuned)
    assert surface is not None
    assert surface.axes == ("gait.sweep_deg", "gait.tilt_deg")
    assert surface.mean.shape == surface.deviation.shape == (41, 41)
    at_best = surface.mean.min()
    assert at_best == pytest.approx(0.2, rel=0.15)
    assert surface.deviation.min() > 0.0
    corner = {"gait.sweep_deg": 40, "gait.tilt_deg": 35}
    assert abs(surface.mean[-1, -1] - error_at(corner)) < 3 * surface.deviation[-1, -1]
    assert surface.to_json()["marks"][1][0] == 10


def test_an_axis_that_is_not_tuned_cannot_be_drawn(tuned: Rows) -> None:
    surface = learned_surface(definition(), tuned, across=["gait.tilt_deg"])
    assert surface is not None
    assert surface.mean.shape == (41,)
    with pytest.raises(ValueError, match=r"not tuned.*gait\.sweep_deg"):
        learned_surface(definition(), tuned, across=["gait.speed"])
