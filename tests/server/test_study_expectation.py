"""How long a study will take is told before it begins, by what it asks for."""

import pytest

from control.studies.checking import survey
from control.studies.definition import StudyDefinition
from server.studies.expectation import PLANNER, RIGID, computing, expected_wall

EIGHT = {"name": "one", "trajectory": {"name": "eight"}}


def asked_for(**change):
    definition = StudyDefinition.from_json({**EIGHT, **change})
    return definition, survey(definition)


def test_laws_that_are_compiled_take_a_hundredth_of_those_that_are_not_and_the_reference_s_waiting_counts():
    quick = computing(*asked_for())
    waiting = {"of": "gait.time_law", "values": ["wait"]}
    assert computing(*asked_for(gait={"time_law": "wait"})) > 100.0 * quick
    assert computing(*asked_for(axes=[waiting])) > 100.0 * quick
    definition, found = asked_for(controller={"name": "planner"})
    assert computing(definition, found) == pytest.approx(PLANNER * found.walking)
    definition, found = asked_for(plant={"name": "rigid"})
    assert computing(definition, found) == pytest.approx(RIGID * found.walking)


def test_a_rig_takes_its_own_time_and_a_simulated_one_without_a_clock_less():
    definition, found = asked_for(on="rig")
    assert expected_wall(definition, found) > found.walking + found.resting
    assert expected_wall(definition, found, headless=True) < found.walking
