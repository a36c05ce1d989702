"""The state table and the arbiter: deny by default."""

import itertools
import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from control.model import Pose, Tracking
from control.safety import (
    CURRENT_MISMATCH,
    ENERGISED,
    FRAME_STALE,
    FRAME_TOO_LATE,
    FROZEN_FRAMES,
    LOOP_STALL,
    NOT_DRIVING,
    PREDICT_FOR,
    TELEMETRY_STALE,
    TRANSITIONS,
    Event,
    Health,
    Limits,
    Refused,
    Severity,
    after,
    assess,
)
from control.snapshot import RigState

GOOD = Health(
    tick_gap=0.0167,
    frame_age=0.0,
    frame_delay=0.035,
    identical_frames=1,
    tracking=Tracking.LOCKED,
    tracking_age=0.0,
    pose=Pose(0.0, 0.0, 0.0),
    link_ready=True,
    link_reason="",
    link_incident="",
    telemetry_age=0.01,
    board_faults=(),
    board_state="driving",
    not_driving=0.0,
    current_mismatch=0.0,
)
LIMITS = Limits()


def test_a_healthy_rig_has_no_findings() -> None:
    assert assess(GOOD, LIMITS) == ()


@pytest.mark.parametrize(
    ("name", "limit", "severity", "code"),
    [
        ("tick_gap", LOOP_STALL, Severity.HOLD, "stall"),
        ("frame_age", FRAME_STALE, Severity.HOLD, "camera"),
        ("frame_delay", FRAME_TOO_LATE, Severity.HOLD, "late"),
        ("tracking_age", PREDICT_FOR, Severity.HOLD, "lost"),
        ("telemetry_age", TELEMETRY_STALE, Severity.DISARM, "telemetry"),
        ("not_driving", NOT_DRIVING, Severity.DISARM, "board"),
        ("current_mismatch", CURRENT_MISMATCH, Severity.DISARM, "current"),
    ],
)
def test_each_limit_holds_up_to_its_value_and_no_further(
    name: str, limit: float, severity: Severity, code: str
) -> None:
    assert assess(replace(GOOD, **{name: limit}), LIMITS) == ()
    for beyond in (math.nextafter(limit, math.inf), 2 * limit, math.inf, math.nan):
        (finding,) = assess(replace(GOOD, **{name: beyond}), LIMITS)
        assert (finding.severity, finding.code) == (severity, code)
        assert finding.message


@pytest.mark.parametrize(
    ("change", "severity", "code"),
    [
        ({"identical_frames": FROZEN_FRAMES}, Severity.HOLD, "frozen"),
        ({"tracking": Tracking.LOST}, Severity.HOLD, "lost"),
        ({"pose": None}, Severity.HOLD, "lost"),
        ({"pose": Pose(math.nan, 0.0, 0.0)}, Severity.HOLD, "lost"),
        ({"pose": Pose(0.063, 0.0, 0.0)}, Severity.WARN, "margin"),
        ({"pose": Pose(0.0, -0.069, 0.0)}, Severity.HOLD, "outside"),
        ({"link_ready": False, "link_reason": "lost the port"}, Severity.DISARM, "link"),
        ({"link_incident": "the board was reset"}, Severity.LATCH, "board-reset"),
        ({"board_faults": ("over-current",)}, Severity.LATCH, "board"),
        ({"board_faults": ("supply_low",)}, Severity.DISARM, "supply"),
        ({"board_faults": ("supply_low", "over-current")}, Severity.LATCH, "board"),
        ({"frame_delay": -0.001}, Severity.HOLD, "late"),
    ],
)
def test_each_condition_has_its_consequence(change: dict[str, object], severity: Severity, code: str) -> None:
    (finding,) = assess(replace(GOOD, **change), LIMITS)  # type: ignore[arg-type]
    assert (finding.severity, finding.code) == (severity, code)


@given(
    st.floats(allow_nan=True), st.floats(allow_nan=True), st.floats(allow_nan=True), st.floats(allow_nan=True)
)
def test_no_float_slips_past_the_arbiter(gap: float, age: float, x: float, silence: float) -> None:
    health = replace(GOOD, tick_gap=gap, frame_age=age, pose=Pose(x, 0.0, 0.0), telemetry_age=silence)
    stops = any(finding.severity >= Severity.HOLD for finding in assess(health, LIMITS))
    is_good = (
        gap <= LOOP_STALL and age <= FRAME_STALE and abs(x) <= LIMITS.hard and silence <= TELEMETRY_STALE
    )
    assert stops != is_good


def test_the_most_severe_finding_comes_first_and_the_others_are_kept() -> None:
    health = replace(GOOD, pose=Pose(0.063, 0.0, 0.0), frame_age=1.0, board_faults=("driver",))
    assert [finding.code for finding in assess(health, LIMITS)] == ["board", "camera", "margin"]


@pytest.mark.parametrize(("state", "event"), list(itertools.product(RigState, Event)))
def test_what_the_table_does_not_list_is_refused_in_words(state: RigState, event: Event) -> None:
    if (state, event) in TRANSITIONS:
        assert after(state, event) is TRANSITIONS[state, event]
    else:
        with pytest.raises(Refused, match=f"cannot {event} while the rig is {state}"):
            after(state, event)


def test_only_arming_and_resuming_lead_to_current() -> None:
    edges = {
        event for (state, event), to in TRANSITIONS.items() if to in ENERGISED and state not in ENERGISED
    }
    assert edges == {Event.ARM, Event.RESUME}


def test_two_deliberate_acts_lead_out_of_a_fault() -> None:
    leaving = {event: to for (state, event), to in TRANSITIONS.items() if state is RigState.FAULT}
    assert leaving == {Event.RESET: RigState.DISARMED}
