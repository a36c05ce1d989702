"""A plan is a pure function of its definition: what is run, with which seed, and in which order."""

from __future__ import annotations

import itertools
import math
import pickle
from collections import Counter

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from control.studies.definition import StudyDefinition
from control.studies.design import sets_of
from control.studies.plan import FixedPlan, half_width
from control.studies.table import StudyRow

TILTS = {"of": "gait.tilt_deg", "from": 20, "to": 30, "step": 5}
STEPS = {"of": "gait.path_step_s", "from": 0.1, "to": 0.3, "step": 0.1}


def definition(**changes):
    return StudyDefinition.from_json({"name": "a", "repeats": 4, "axes": [TILTS, STEPS], **changes})


def row(plan, index, error):
    run = plan.run(index)
    metrics = {"normalized_mean_error": error}
    return StudyRow(index, run.set, run.repeat, run.seed, "finished", run.values, metrics)


class Counted(dict):
    """Rows, and how often one of them was read: a study's rows are on the disk."""

    read = 0

    def __getitem__(self, index):
        self.read += 1
        return super().__getitem__(index)


def start_of_run(plan, index):
    start = plan.run(index).start
    assert start is not None
    return start


orders = st.sampled_from(["blocked", "random", "listed"])


@given(st.integers(0, 2**31 - 1), st.integers(1, 6), orders)
@settings(max_examples=30, deadline=None)
def test_every_order_has_each_run_once_and_leaves_each_run_as_it_is(seed, repeats, order):
    plan, listed = (
        definition(seed=seed, repeats=repeats, order=one).plan() for one in (order, "listed")
    )  # fmt: skip
    assert sorted(plan.next({})) == list(range(9 * repeats))
    assert plan.run(9 * repeats - 1) == listed.run(9 * repeats - 1)


def test_a_grid_covers_every_combination_and_its_last_axis_changes_fastest():
    sets = [tuple(one.values()) for one in sets_of(definition())]
    assert sets == list(itertools.product([20, 25, 30], [0.1, 0.2, 0.3]))


def test_a_step_does_not_lose_the_end_of_its_range_to_rounding():
    axis = {"of": "controller.gain", "from": 0.1, "to": 0.7, "step": 0.1}
    values = [one["controller.gain"] for one in sets_of(definition(axes=[axis]))]
    assert values == [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7]


@given(st.integers(0, 2**31 - 1))
@settings(max_examples=20, deadline=None)
def test_each_block_holds_each_set_once(seed):
    plan = definition(seed=seed).plan()
    order = plan.next({})
    for block in np.array(order).reshape(4, 9).tolist():
        assert sorted(plan.run(index).set for index in block) == list(range(9))
        assert len({plan.run(index).repeat for index in block}) == 1


def test_blocks_and_the_random_order_are_shuffled_and_follow_the_seed():
    first, same, other = (definition(seed=seed).plan().next({}) for seed in (1, 1, 2))
    assert first == same != other
    assert [index % 9 for index in first[:9]] != [index % 9 for index in first[9:18]]
    assert definition(order="random").plan().next({}) != first


def test_listed_runs_go_set_by_set():
    plan = definition(order="listed").plan()
    assert [plan.run(index).set for index in plan.next({})] == [
        number for number in range(9) for _ in range(4)
    ]


def test_more_repeats_leave_the_runs_that_are_there_as_they_were():
    few, many = definition(repeats=2).plan(), definition(repeats=50).plan()
    assert [few.run(index) for index in range(18)] == [many.run(index) for index in range(18)]


def test_what_is_done_is_not_asked_for_again():
    plan = definition().plan()
    order = list(plan.next({}))
    done = {index: row(plan, index, 0.1) for index in order[::2]}
    assert plan.next(done) == order[1::2]
    assert plan.next({index: row(plan, index, 0.1) for index in order}) == []


def test_seeds_differ_between_runs_and_studies_and_fit_json():
    seeds = [
        plan.run(index).seed
        for plan in (definition(seed=1).plan(), definition(seed=2).plan())
        for index in range(36)
    ]
    assert len(set(seeds)) == 72
    assert all(0 <= seed < 2**53 for seed in seeds)


def test_a_run_carries_its_values_in_si_to_another_process():
    run = definition(passes=0.5, duration_s=20.0).plan().run(4)
    assert run == pickle.loads(pickle.dumps(run))
    assert run.values == {"gait.tilt_deg": 25, "gait.path_step_s": 0.2}
    assert run.selection.gait.tilt == pytest.approx(math.radians(25.0))
    assert run.selection.gait.path_step == 0.2
    assert (run.passes, run.duration, run.setup.length) == (0.5, 20.0, 0.010)


def test_a_run_starts_at_the_first_point_of_its_path_heading_along_it():
    start = start_of_run(definition().plan(), 0)
    assert (start.x, start.y) == pytest.approx((0.0, -0.040))
    assert abs(start.heading) == pytest.approx(math.pi, abs=1e-3)


def test_a_start_of_ones_own_is_kept_and_its_scatter_is_drawn_for_each_run():
    own = {"x_mm": 3.0, "heading_deg": 90.0}
    assert start_of_run(definition(start=own).plan(), 0).x == pytest.approx(0.003)
    plan = definition(start={**own, "scatter_mm": 1.0, "scatter_deg": 5.0}, repeats=200).plan()
    starts = np.array([(s.x, s.y, s.heading) for s in (start_of_run(plan, index) for index in range(1800))])
    assert starts.mean(axis=0) == pytest.approx((0.003, -0.040, math.pi / 2), abs=0.01)
    assert starts.std(axis=0) == pytest.approx((0.001, 0.001, math.radians(5.0)), rel=0.06)
    assert plan.run(17).start == plan.run(17).start


def test_a_rig_walks_back_to_the_start_itself_without_scatter():
    scatter = {"scatter_mm": 10.0, "scatter_deg": 90.0}
    assert start_of_run(definition(start=scatter, on="rig").plan(), 5) == start_of_run(definition().plan(), 0)


@given(st.integers(0, 2**31 - 1), st.integers(2, 40))
@settings(max_examples=20, deadline=None)
def test_a_latin_hypercube_has_one_point_in_each_part_of_each_axis(seed, sets):
    axes = [
        {"of": "gait.tilt_deg", "from": 10, "to": 35},
        {"of": "controller.gain", "from": 1.0, "to": 9.0},
    ]
    plan = FixedPlan(definition(design="latin", latin={"sets": sets}, axes=axes, seed=seed))
    for name, low, high in (("gait.tilt_deg", 10.0, 35.0), ("controller.gain", 1.0, 9.0)):
        shares = [(float(one[name] or 0.0) - low) / (high - low) for one in plan.sets]
        assert sorted(int(share * sets - 1e-9) for share in shares) == list(range(sets))


def test_a_latin_hypercube_shares_names_and_steps_out_evenly():
    axes = [
        {"of": "controller", "values": ["geometric", "planner"]},
        {"of": "gait.sweep_deg", "from": 10, "to": 40, "step": 10},
    ]
    plan = FixedPlan(definition(design="latin", latin={"sets": 16}, axes=axes))
    assert Counter(one["controller"] for one in plan.sets) == {"geometric": 8, "planner": 8}
    assert Counter(one["gait.sweep_deg"] for one in plan.sets) == {10: 4, 20: 4, 30: 4, 40: 4}


def test_another_controller_starts_from_its_own_defaults():
    raw = {
        "name": "a",
        "controller": {"name": "geometric", "parameters": {"gain": 5.0}},
        "axes": [{"of": "controller", "values": ["geometric", "gradient"]}],
    }
    plan = StudyDefinition.from_json(raw).plan()
    assert plan.run(0).selection.controller.parameters["gain"] == 5.0
    assert "gain" not in plan.run(1).selection.controller.parameters
    assert plan.run(1).selection.build_controller().name == "gradient"


def test_a_listed_set_may_leave_a_value_at_the_definitions_own():
    raw = {"name": "a", "design": "list", "sets": [{"controller.gain": 5}, {"controller": "planner"}]}
    plan = StudyDefinition.from_json(raw).plan()
    assert plan.axes == ("controller.gain", "controller")
    assert plan.run(0).values == {"controller.gain": 5, "controller": None}
    assert plan.run(0).selection.controller.name == "geometric"


def test_a_plan_without_axes_is_one_set():
    assert isinstance(plan := StudyDefinition.from_json({"name": "a", "repeats": 3}).plan(), FixedPlan)
    assert plan.total == 3
    assert plan.run(2).set == 0


@pytest.mark.parametrize("index", [-1, 36])
def test_a_run_outside_the_plan_is_an_error(index):
    with pytest.raises(IndexError):
        definition().plan().run(index)


def finish(plan, error, pick):
    """Carry a plan out, `pick` choosing which of the runs offered is done next; returns the rows."""
    done = {}
    while left := plan.next(done):
        index = pick(left)
        done[index] = row(plan, index, error(plan.run(index)))
    return done


def _scatter(run):
    """One tilt repeats itself to a percent, the others scatter by a third."""
    spread = 0.01 if run.values["gait.tilt_deg"] == 25 else 0.5
    return 1.0 + spread * ((run.seed % 1000) / 1000.0 - 0.5)


def test_a_set_that_is_known_well_enough_gets_no_more_repeats_whatever_the_timing():
    changes = {"repeats": 12, "stop": {"half_width_percent": 5.0}, "axes": [TILTS]}
    forward, backward = (
        finish(definition(**changes).plan(), _scatter, pick)
        for pick in (lambda left: left[0], lambda left: left[-1])
    )
    assert forward == backward
    runs = Counter(one.values["gait.tilt_deg"] for one in forward.values())
    assert runs[25] == 3
    assert runs[20] > 3


def test_what_is_known_well_enough_is_found_by_reading_each_row_once():
    plan = definition(repeats=12, stop={"half_width_percent": 5.0}, axes=[TILTS]).plan()
    done = Counted(finish(plan, _scatter, lambda left: left[0]))
    done.read = 0
    assert plan.next(done) == []
    assert done.read == len(done)


def test_the_half_width_is_students():
    assert half_width([1.0, 2.0]) == math.inf
    assert half_width([1.0, 2.0, 3.0]) == pytest.approx(4.302653 / math.sqrt(3.0) / 2.0, rel=1e-6)
    assert half_width([math.nan, 1.0, 1.0]) == math.inf
