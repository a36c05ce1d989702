"""What a study's definition says is kept, and what it gets wrong is told in words."""

from __future__ import annotations

import json
import math
import tomllib

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from control.studies.checking import check, survey
from control.studies.definition import StudyDefinition
from control.studies.errors import StudyError
from control.studies.examples import examples
from control.studies.quantities import quantity

TILTS = {"of": "gait.tilt_deg", "values": [20, 25, 30]}

degrees = st.floats(10.0, 40.0, allow_nan=False)
ranges = st.tuples(degrees, st.floats(0.5, 10.0), st.floats(0.1, 3.0)).map(
    lambda r: {"of": "gait.tilt_deg", "from": r[0], "to": r[0] + r[1], "step": r[2]}
)
lists = st.lists(degrees | st.integers(10, 40), min_size=1, max_size=5, unique=True).map(
    lambda values: {"of": "gait.sweep_deg", "values": values}
)
definitions = st.fixed_dictionaries(
    {
        "name": st.text(
            st.characters(codec="utf-8", categories=("L", "N", "P", "S")), min_size=1, max_size=40
        ),
        "repeats": st.integers(1, 1000),
        "order": st.sampled_from(["blocked", "random", "listed"]),
        "seed": st.integers(0, 2**31 - 1),
        "passes": st.floats(0.01, 100.0),
        "axes": st.tuples(ranges, lists).map(list),
        "gait": st.fixed_dictionaries({"max_rate_deg_s": st.floats(1.0, 300.0)}),
        "controller": st.just({"name": "geometric", "parameters": {"gain": 2.5}}),
    }
)


@given(definitions)
@settings(max_examples=50, deadline=None)
def test_a_definition_survives_toml_and_json(raw):
    definition = StudyDefinition.from_json(raw)
    assert StudyDefinition.from_toml(definition.to_toml()) == definition
    assert StudyDefinition.from_json(json.loads(json.dumps(definition.to_json()))) == definition


@pytest.mark.parametrize("name", examples())
def test_every_example_can_be_carried_out(name):
    definition = StudyDefinition.from_toml(examples()[name])
    found = check(definition)
    assert found.runs >= 2
    assert found.walking > 0.0
    assert StudyDefinition.from_toml(definition.to_toml()) == definition


def test_the_papers_study_has_63_sets_of_ten_runs_and_lasts_as_long_as_its_eights():
    found = survey(StudyDefinition.from_toml(examples()["paper-section-6"]))
    assert (found.sets, found.runs) == (63, 630)
    eights = 40.0 * math.pi * (1.0 + 1.0 / 2.0 + 1.0 / 3.0)
    assert found.walking == pytest.approx(210 * eights, rel=1e-6)


def test_a_duration_caps_every_run_of_the_estimate():
    raw = {"name": "short", "duration_s": 50.0, "axes": [{"of": "gait.path_step_s", "values": [0.1, 0.5]}]}
    found = survey(StudyDefinition.from_json(raw))
    assert found.walking == pytest.approx(50.0 + 8.0 * math.pi, rel=1e-6)


def test_dotted_names_in_a_listed_set_may_be_tables():
    nested = 'name="a"\ndesign="list"\n[[sets]]\ngait.tilt_deg = 20\ngait.sweep_deg = 10\n'
    quoted = 'name="a"\ndesign="list"\n[[sets]]\n"gait.tilt_deg" = 20\n"gait.sweep_deg" = 10\n'
    assert StudyDefinition.from_toml(nested) == StudyDefinition.from_toml(quoted)


def test_whole_numbers_are_the_same_from_a_form_and_from_a_file():
    assert StudyDefinition.from_json({"name": "a", "axes": [TILTS]}) == StudyDefinition.from_json(
        {"name": "a", "axes": [{**TILTS, "values": [20.0, 25.0, 30.0]}]}
    )


@pytest.mark.parametrize(
    ("raw", "words"),
    [
        ({}, "name: Field required"),
        ({"name": "a", "repeats": 0}, "repeats: Input should be greater than or equal to 1 (given: 0)"),
        ({"name": "a", "repeats": "10"}, "repeats: Input should be a valid integer (given: '10')"),
        ({"name": "a", "gait": {"tilt_deg": 60}}, "gait.tilt_deg: Input should be less than or equal to 45"),
        ({"name": "a", "passes": math.nan}, "passes: Input should be a finite number"),
        ({"name": "a", "axes": [TILTS, TILTS]}, "the axis gait.tilt_deg is there twice"),
        ({"name": "a", "axes": [{"of": "gait.tilt", "values": [1]}]}, "gait has no 'tilt'; choose one of: sweep_deg"),
        ({"name": "a", "axes": [{"of": "weather", "values": [1]}]}, "nothing is called 'weather'"),
        ({"name": "a", "axes": [{"of": "gait.tilt_deg", "values": [20, 20.0]}]}, "20 is there twice"),
        ({"name": "a", "axes": [{"of": "gait.tilt_deg", "from": 10, "to": 20}]}, "needs a step"),
        ({"name": "a", "axes": [{"of": "gait.tilt_deg", "from": 20, "to": 10, "step": 1}]}, "the smaller one first"),
        ({"name": "a", "axes": [{"of": "gait.tilt_deg"}]}, "needs either values"),
        ({"name": "a", "axes": [{"of": "controller", "from": 1, "to": 2, "step": 1}]}, "takes names"),
        ({"name": "a", "axes": [{"of": "controller.gain", "from": 0, "to": 1e9, "step": 1e-9}]}, "more than 1000"),
        ({"name": "a", "design": "latin"}, "needs at least one [[axes]]"),
        ({"name": "a", "design": "list"}, "needs at least one [[sets]]"),
        ({"name": "a", "sets": [{"gait.tilt_deg": 20}]}, 'belong to design = "list"'),
        ({"name": "a", "design": "list", "sets": [{"controller": "planner"}] * 2}, "sets 0 and 1 are the same"),
        ({"name": "a", "on": "rig", "axes": [{"of": "plant", "values": ["slip"]}]}, "can only be varied in a batch"),
        ({"name": "a", "repeats": 100_000, "axes": [{**TILTS, "values": list(range(10, 40))}]}, "1000000 runs"),
        ({"name": "a", "order": "random", "stop": {"half_width_percent": 5}}, 'needs order = "blocked"'),
        ({"name": "a", "design": "tune", "axes": [TILTS], "tune": {"budget": 10}}, "tune.budget is 10 runs"),
        ({"name": "a", "axes": [{**TILTS, "values": []}]}, "axes.0.values: Tuple should have at least 1 item"),
        ({"name": "a", "axes": [{**TILTS, "values": [[1]]}]}, "a number, a name or a switch (given: [1])"),
        ({"name": "a", "axes": [{**TILTS, "values": [math.inf]}]}, "a number has to be finite (given: inf)"),
        ({"name": "a", "axes": [{**TILTS, "values": ["x" * 201]}]}, "a name has at most 200 characters"),
        ({"name": "a", "plant": {"name": "slip", "parameters": {"x": {"y": [None]}}}}, "x holds a null"),
        ({"name": "a", "design": "tune", "axes": [TILTS], "tune": {"budget": 1001}}, "less than or equal to 1000"),
        ({"name": "a", "surprise": 1}, "surprise: Extra inputs are not permitted"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_told_in_words(raw, words):
    with pytest.raises(StudyError) as refused:
        StudyDefinition.from_json(raw)
    assert words in str(refused.value)


def test_a_wrong_value_is_complained_of_once_and_shown_in_short():
    with pytest.raises(StudyError) as refused:
        StudyDefinition.from_json({"name": "a", "repeats": "x" * 10_000, "sets": [{"gait.tilt_deg": [1]}]})
    _, *lines = str(refused.value).splitlines()
    assert sum("sets.0.gait.tilt_deg" in line for line in lines) == 1
    assert all(len(line) < 250 for line in lines)


def test_what_is_no_toml_is_told_in_words():
    with pytest.raises(StudyError, match="this is no TOML"):
        StudyDefinition.from_toml("name = ")


def test_a_date_in_a_file_is_refused_and_not_a_crash():
    assert tomllib.loads("name = 1979-05-27")
    with pytest.raises(StudyError, match="this is no study"):
        StudyDefinition.from_toml("name = 1979-05-27")


@pytest.mark.parametrize(
    ("axis", "words"),
    [
        ({"of": "gait.tilt_deg", "values": [20, 60]}, "set 1 (gait.tilt_deg = 60)"),
        ({"of": "controller", "values": ["geometric", "magic"]}, "there is no controller called 'magic'"),
        ({"of": "controller.gain", "values": [3, 1000]}, "gain: Input should be less than or equal to 100"),
        ({"of": "controller.gian", "values": [3]}, "gian: Extra inputs are not permitted"),
        ({"of": "trajectory.width_mm", "values": [80, 200]}, "the workspace ends at ±60 mm"),
        ({"of": "plant", "values": ["slip", "sticky"]}, "there is no plant called 'sticky'"),
        ({"of": "setup.workspace_mm", "values": [120, 60]}, "the workspace ends at ±30 mm"),
    ],
)
def test_a_set_that_cannot_be_carried_out_is_named_with_its_values(axis, words):
    definition = StudyDefinition.from_json({"name": "a", "axes": [axis]})
    with pytest.raises(StudyError) as refused:
        check(definition)
    assert words in str(refused.value)


def test_a_start_outside_the_workspace_is_refused():
    definition = StudyDefinition.from_json({"name": "a", "start": {"x_mm": 70}})
    with pytest.raises(StudyError, match=r"the start at \(70.0, -40.0\) mm is outside"):
        check(definition)


def test_a_rigs_own_workspace_counts_where_it_is_given():
    definition = StudyDefinition.from_json({"name": "a", "on": "rig"})
    check(definition, workspace=0.06)
    with pytest.raises(StudyError, match="the workspace ends at ±35 mm"):
        check(definition, workspace=0.035)


def test_many_bad_sets_are_counted():
    axis = {"of": "gait.tilt_deg", "from": 50, "to": 69, "step": 1}
    found = survey(StudyDefinition.from_json({"name": "a", "axes": [axis]}))
    assert len(found.problems) == 6
    assert found.problems[-1] == "and 15 more sets of this study"


def test_the_corners_of_a_tuning_are_looked_at():
    raw = {"name": "a", "design": "tune", "axes": [{"of": "gait.tilt_deg", "from": 10, "to": 50}]}
    with pytest.raises(StudyError, match=r"gait\.tilt_deg = 50"):
        check(StudyDefinition.from_json(raw))


def test_an_axis_has_the_title_and_unit_of_its_parameter():
    definition = StudyDefinition.from_json(
        {"name": "a", "axes": [TILTS, {"of": "controller", "values": ["planner", "geometric"]}]}
    )
    labels = {name: quantity(definition, name).label for name in definition.axis_names}
    assert labels == {"gait.tilt_deg": "Tilt (°)", "controller": "Controller"}
    assert quantity(definition, "controller.gain").unit == "1/(cm·s)"
    assert quantity(definition, "mean_error_mm").label == "Mean error (mm)"
    assert quantity(definition, "plant.unknown").title == "plant.unknown"
