"""The table of the rig's states: deny by default. And what a gait may ask for."""

import itertools
import math
from dataclasses import replace

import pytest

from control.gait import Gait
from control.safety import ENERGISED, TRANSITIONS, Event, Limits, Refused, after, check_gait
from control.snapshot import RigState

LISTED = {
    ("disarmed", "arm"): "armed",
    ("disarmed", "latch"): "fault",
    ("armed", "start"): "running",
    ("armed", "jog"): "armed",
    ("armed", "hold"): "held",
    ("armed", "disarm"): "disarmed",
    ("armed", "latch"): "fault",
    ("running", "finish"): "armed",
    ("running", "hold"): "held",
    ("running", "disarm"): "disarmed",
    ("running", "latch"): "fault",
    ("held", "resume"): "running",
    ("held", "disarm"): "disarmed",
    ("held", "latch"): "fault",
    ("fault", "reset"): "disarmed",
}
"""The whole table once more, by hand."""


@pytest.mark.parametrize(("state", "event"), list(itertools.product(RigState, Event)))
def test_every_event_in_every_state_does_what_is_listed_or_is_refused_in_words(state, event) -> None:
    following = LISTED.get((state.value, event.value))
    if following is not None:
        assert after(state, event) is RigState(following)
    else:
        with pytest.raises(Refused, match=f"cannot {event} while the rig is {state}: "):
            after(state, event)


def test_every_refusal_says_what_to_do() -> None:
    advice = {
        RigState.DISARMED: (Event.START, "arm it first"),
        RigState.ARMED: (Event.ARM, "it is armed and free"),
        RigState.RUNNING: (Event.START, "stop the run first"),
        RigState.HELD: (Event.START, "resume it, stop the run or disarm"),
        RigState.FAULT: (Event.ARM, "reset it first"),
    }
    for state, (event, words) in advice.items():
        with pytest.raises(Refused, match=words):
            after(state, event)


def test_only_arming_and_resuming_lead_to_current() -> None:
    edges = {
        event for (state, event), to in TRANSITIONS.items() if to in ENERGISED and state not in ENERGISED
    }
    assert edges == {Event.ARM, Event.RESUME}


def test_two_deliberate_acts_lead_out_of_a_fault() -> None:
    leaving = {event: to for (state, event), to in TRANSITIONS.items() if state is RigState.FAULT}
    assert leaving == {Event.RESET: RigState.DISARMED}


def test_no_state_with_current_but_armed_and_running() -> None:
    assert {RigState.ARMED, RigState.RUNNING} == ENERGISED


# Gaits -------------------------------------------------------------------------------------------

LIMITS = Limits((8.0, 8.0, 8.0), field=0.015, rate=math.radians(360.0), soft=0.062, hard=0.068)


def test_a_gait_at_the_limits_is_allowed() -> None:
    check_gait(Gait(field=0.015, max_rate=math.radians(360.0)), LIMITS)
    check_gait(Gait(field=0.0, max_rate=0.0), LIMITS)


@pytest.mark.parametrize("field", [0.01501, -0.001, math.nan, math.inf])
def test_a_field_beyond_its_limit_is_refused_in_the_labs_units(field: float) -> None:
    with pytest.raises(Refused, match=r"the field of .* mT is beyond this rig's 15 mT; choose less"):
        check_gait(replace(Gait(), field=field), LIMITS)


@pytest.mark.parametrize("rate", [math.radians(360.1), -0.1, math.nan, math.inf])
def test_a_swing_beyond_its_limit_is_refused_in_the_labs_units(rate: float) -> None:
    with pytest.raises(
        Refused, match=r"the fastest swing of .* degrees/s is beyond this rig's 360 degrees/s"
    ):
        check_gait(replace(Gait(), max_rate=rate), LIMITS)
