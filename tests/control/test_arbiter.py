"""The failsafe arbiter: what is good is accepted, everything else stops, the most severe comes first."""

import itertools
import math
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from control.arbiter import (
    CLOCK_GAP,
    CURRENT_MISMATCH,
    FRAME_STALE,
    FRAME_TOO_LATE,
    FROZEN_FRAMES,
    LINE_BAD,
    LINE_POOR,
    LINE_SLOW,
    LINE_TOO_SLOW,
    LOOP_STALL,
    NOT_DRIVING,
    PREDICT_FOR,
    STUCK_SHOWN,
    TELEMETRY_STALE,
    Finding,
    Health,
    Severity,
    assess,
    verdict,
)
from control.coil_heat import OFF_AT, WARN_AT
from control.current_check import AGREED, Mismatch
from control.model import Pose, Tracking
from control.response import AWAY
from control.safety import Limits

LIMITS = Limits((8.0, 8.0, 8.0), field=0.015, rate=math.radians(360.0), soft=0.062, hard=0.068)
OPEN_LEAD = Mismatch("coil", "coil x shows no current")
GOOD = Health(
    tick_gap=0.0167,
    frame_age=0.0,
    frame_delay=0.035,
    frame_problem="",
    identical_frames=1,
    tracking=Tracking.LOCKED,
    tracking_age=0.0,
    pose=Pose(0.0, 0.0, 0.0),
    reach_limit=0.068,
    turned_away=0.0,
    stuck_age=math.inf,
    link_ready=True,
    link_reason="",
    link_incident="",
    bad_share=0.0,
    line_lateness=0.017,
    telemetry_age=0.01,
    board_faults=(),
    board_state="driving",
    not_driving=0.0,
    current_mismatch=0.0,
    mismatch=AGREED,
    coil_heat=(0.1, 0.2, 0.3),
    is_too_hot=False,
    heat_wait=0.0,
)
HOLD, DISARM, LATCH, WARN = Severity.HOLD, Severity.DISARM, Severity.LATCH, Severity.WARN


def after(**changes: Any) -> list[tuple[Severity, str]]:
    return [(f.severity, f.code) for f in assess(replace(GOOD, **changes), LIMITS)]


def message(**changes: Any) -> str:
    (finding,) = assess(replace(GOOD, **changes), LIMITS)
    return finding.message


def test_the_thresholds_are_those_that_were_derived_or_measured() -> None:
    in_milliseconds = (FRAME_STALE, FRAME_TOO_LATE, PREDICT_FOR, TELEMETRY_STALE, LOOP_STALL, CLOCK_GAP)
    assert in_milliseconds == (0.100, 0.150, 0.150, 0.300, 0.200, 1.0)
    assert (CURRENT_MISMATCH, NOT_DRIVING, STUCK_SHOWN) == (0.100, 0.150, 5.0)
    assert (LINE_POOR, LINE_BAD, FROZEN_FRAMES) == (0.01, 0.10, 3)
    assert (LINE_SLOW, LINE_TOO_SLOW) == (0.100, 0.200)
    assert (WARN_AT, OFF_AT) == (0.8, 1.0)
    assert math.radians(4.0) == AWAY


def just_beyond(limit: float) -> float:
    return math.nextafter(limit, math.inf)


def test_a_healthy_rig_has_no_findings() -> None:
    assert assess(GOOD, LIMITS) == ()
    assert verdict(()) is Severity.OK


@pytest.mark.parametrize(
    ("name", "limit", "severity", "code"),
    [
        ("tick_gap", LOOP_STALL, HOLD, "stall"),
        ("frame_age", FRAME_STALE, HOLD, "camera"),
        ("frame_delay", FRAME_TOO_LATE, HOLD, "late"),
        ("tracking_age", PREDICT_FOR, HOLD, "lost"),
        ("turned_away", AWAY, DISARM, "sign"),
        ("telemetry_age", TELEMETRY_STALE, DISARM, "telemetry"),
        ("not_driving", NOT_DRIVING, DISARM, "board"),
        ("bad_share", LINE_POOR, WARN, "line"),
        ("line_lateness", LINE_SLOW, WARN, "slow"),
    ],
)
def test_each_limit_holds_up_to_its_value_and_no_further(name, limit, severity, code) -> None:
    assert after(**{name: limit}) == []
    assert after(**{name: just_beyond(limit)}) == [(severity, code)]


@pytest.mark.parametrize("value", [math.nan, math.inf])
@pytest.mark.parametrize(
    ("name", "severity", "code"),
    [
        ("tick_gap", HOLD, "clock"),
        ("frame_age", HOLD, "camera"),
        ("frame_delay", HOLD, "late"),
        ("identical_frames", HOLD, "frozen"),
        ("tracking_age", HOLD, "lost"),
        ("turned_away", DISARM, "sign"),
        ("telemetry_age", DISARM, "telemetry"),
        ("not_driving", DISARM, "board"),
        ("bad_share", DISARM, "line"),
        ("line_lateness", DISARM, "slow"),
    ],
)
def test_what_is_no_number_is_on_the_safe_side(name, severity, code, value) -> None:
    assert after(**{name: value}) == [(severity, code)]


def test_every_float_of_the_health_is_safe_when_it_is_no_number() -> None:
    """Whatever field may be added: not a number never passes for good health, but for a mere explanation."""
    explains = {"heat_wait"}
    for name in GOOD.__dataclass_fields__:
        if isinstance(getattr(GOOD, name), float) and name not in explains:
            assert after(**{name: math.nan}), name


# The loop ----------------------------------------------------------------------------------------


def test_a_gap_is_a_busy_computer_up_to_a_second_and_a_sleeping_one_beyond() -> None:
    assert after(tick_gap=0.0) == []
    assert after(tick_gap=CLOCK_GAP) == [(HOLD, "stall")]
    assert after(tick_gap=just_beyond(CLOCK_GAP)) == [(HOLD, "clock")]
    assert after(tick_gap=-1e-9) == [(HOLD, "clock")]
    assert message(tick_gap=0.3) == "the loop stood still for 0.30 s"
    assert "2.50 s passed between two ticks" in message(tick_gap=2.5)


# The camera --------------------------------------------------------------------------------------


def test_a_picture_of_another_camera_disarms() -> None:
    assert after(frame_problem="wrong size") == [(DISARM, "frame")]
    assert message(frame_problem="wrong size") == "wrong size"


def test_a_calibration_of_another_camera_disarms_and_says_whose_it_is() -> None:
    assert after(calibration_problem="another camera's") == [(DISARM, "calibration")]
    assert message(calibration_problem="another camera's") == "another camera's"


def test_three_identical_pictures_are_a_frozen_camera() -> None:
    assert after(identical_frames=FROZEN_FRAMES - 1) == []
    assert after(identical_frames=FROZEN_FRAMES) == [(HOLD, "frozen")]
    assert after(identical_frames=FROZEN_FRAMES + 1) == [(HOLD, "frozen")]


def test_a_picture_from_the_future_is_as_bad_as_an_old_one() -> None:
    assert after(frame_delay=0.0) == []
    assert after(frame_delay=-1e-6) == [(HOLD, "late")]
    assert message(frame_delay=0.2) == "frames are 200 ms old, 0 to 150 ms are allowed"


def test_a_camera_that_is_away_holds_with_the_reason() -> None:
    """The reason alone is no fault while pictures come: it is the age of the newest that counts."""
    trouble = "camera v4l://0 is not plugged in"
    assert after(frame_age=0.2, camera_trouble=trouble) == [(HOLD, "camera")]
    assert message(frame_age=0.2, camera_trouble=trouble) == trouble
    assert after(camera_trouble=trouble) == []


def test_a_camera_that_never_sent_a_picture_says_so() -> None:
    assert message(frame_age=math.inf) == "no frame yet"
    assert message(frame_age=0.25) == "no frame for 0.25 s"


# The robot ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "changes",
    [
        {"tracking": Tracking.LOST},
        {"pose": None},
        {"pose": Pose(math.nan, 0.0, 0.0)},
        {"pose": Pose(0.0, math.inf, 0.0)},
        {"pose": Pose(0.0, 0.0, math.nan)},
    ],
)
def test_a_robot_that_is_not_known_to_be_anywhere_holds(changes) -> None:
    assert after(**changes) == [(HOLD, "lost")]


def test_a_robot_that_is_predicted_goes_on_for_a_while() -> None:
    assert after(tracking=Tracking.PREDICTED) == []


@pytest.mark.parametrize("at", [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)])
def test_both_margins_hold_on_every_side(at: tuple[float, float]) -> None:
    def robot(out: float) -> dict[str, Pose]:
        return {"pose": Pose(at[0] * out, at[1] * out, 0.0)}

    assert after(**robot(LIMITS.soft)) == []
    assert after(**robot(just_beyond(LIMITS.soft))) == [(WARN, "margin")]
    assert after(**robot(LIMITS.hard)) == [(WARN, "margin")]
    assert after(**robot(just_beyond(LIMITS.hard))) == [(HOLD, "outside")]


def test_a_robot_on_its_way_back_in_has_a_limit_of_its_own() -> None:
    beyond = Pose(0.070, 0.0, 0.0)
    assert after(pose=beyond, reach_limit=0.0701) == [(WARN, "margin")]
    assert after(pose=Pose(0.0702, 0.0, 0.0), reach_limit=0.0701) == [(HOLD, "outside")]
    assert "at (70.2, 0.0) mm, the limit is ±70.1 mm" in message(
        pose=Pose(0.0702, 0.0, 0.0), reach_limit=0.0701
    )
    assert "at (64.0, -1.5) mm, beyond ±62 mm" in message(pose=Pose(0.064, -0.0015, 0.0))


def test_a_robot_that_does_not_make_its_sweeps_is_shown_for_a_while() -> None:
    assert after(stuck_age=0.0) == [(WARN, "stuck")]
    assert after(stuck_age=STUCK_SHOWN) == [(WARN, "stuck")]
    assert after(stuck_age=just_beyond(STUCK_SHOWN)) == []
    assert after(stuck_age=math.nan) == [(WARN, "stuck")]


# The board ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("changes", "severity", "code", "words"),
    [
        ({"link_incident": "the board was reset"}, LATCH, "board-reset", "the board was reset"),
        ({"link_ready": False, "link_reason": "lost the port"}, DISARM, "link", "lost the port"),
        ({"telemetry_age": math.inf}, DISARM, "telemetry", "no word from the board yet"),
        ({"board_faults": ("supply_low",)}, DISARM, "supply", "switch it on"),
        ({"board_faults": ("over_current",)}, LATCH, "board", "the board reports: over_current"),
        ({"board_faults": ("supply_low", "driver_fault")}, LATCH, "board", "supply_low, driver_fault"),
        (
            {"not_driving": 0.2, "board_state": "expired"},
            HOLD,
            "expired",
            "no fresh command reached the board",
        ),
        ({"not_driving": 0.2, "board_state": "stopped"}, DISARM, "board", "does not drive: it is stopped"),
    ],
)
def test_each_thing_about_the_board_has_its_consequence(changes, severity, code, words) -> None:
    assert after(**changes) == [(severity, code)]
    assert words in message(**changes)


def test_a_current_that_is_not_as_commanded_disarms_with_its_cause_after_a_while() -> None:
    assert after(current_mismatch=CURRENT_MISMATCH, mismatch=OPEN_LEAD) == []
    for beyond in (just_beyond(CURRENT_MISMATCH), math.inf, math.nan):
        assert after(current_mismatch=beyond, mismatch=OPEN_LEAD) == [(DISARM, "coil")]
    assert message(current_mismatch=1.0, mismatch=OPEN_LEAD) == OPEN_LEAD.message


def test_a_poor_line_warns_and_a_bad_one_disarms() -> None:
    assert after(bad_share=LINE_BAD) == [(WARN, "line")]
    assert after(bad_share=just_beyond(LINE_BAD)) == [(DISARM, "line")]
    assert message(bad_share=0.25).startswith("25% of the messages")


def test_a_slow_line_warns_and_one_that_is_slower_than_the_dead_man_disarms() -> None:
    assert after(line_lateness=LINE_TOO_SLOW) == [(WARN, "slow")]
    assert after(line_lateness=just_beyond(LINE_TOO_SLOW)) == [(DISARM, "slow")]
    assert "a command and its echo take 233 ms" in message(line_lateness=0.233)


def test_a_line_that_is_both_poor_and_slow_says_both() -> None:
    assert after(line_lateness=0.15, bad_share=0.2) == [(DISARM, "line"), (WARN, "slow")]


# The heat ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("coil", [0, 1, 2])
def test_each_coil_warns_above_80_percent_and_holds_from_all_its_heat_on(coil: int) -> None:
    def hot(share: float) -> list[tuple[Severity, str]]:
        shares = [0.0, 0.0, 0.0]
        shares[coil] = share
        return after(coil_heat=tuple(shares))

    assert hot(WARN_AT) == []
    assert hot(just_beyond(WARN_AT)) == [(WARN, "heat")]
    assert hot(math.nextafter(OFF_AT, 0.0)) == [(WARN, "heat")]
    for share in (OFF_AT, 2.0, math.inf, math.nan):
        assert hot(share) == [(HOLD, "heat")]


def test_coils_that_must_cool_down_hold_whatever_they_have_come_to() -> None:
    assert after(is_too_hot=True) == [(HOLD, "heat")]
    words = message(is_too_hot=True, coil_heat=(0.5, 0.95, 0.2), heat_wait=600.0)
    assert words == "coil y is at 95% of the heat it may have; it must cool to 80%, in about 10 min"


def test_the_hottest_coil_is_named_and_one_that_is_no_number_is_the_hottest() -> None:
    assert message(coil_heat=(0.85, 0.81, 0.9)).startswith("coil z is at 90%")
    assert message(coil_heat=(2.0, math.nan, 0.9)).startswith("coil y is at nan%")


# Together ----------------------------------------------------------------------------------------


@given(*[st.floats()] * 5)
def test_no_float_slips_past_the_arbiter(
    gap: float, age: float, x: float, silence: float, heat: float
) -> None:
    health = replace(
        GOOD,
        tick_gap=gap,
        frame_age=age,
        pose=Pose(x, 0.0, 0.0),
        telemetry_age=silence,
        coil_heat=(0.0, heat, 0.0),
    )
    stops = verdict(assess(health, LIMITS)) >= HOLD
    is_good = (
        0.0 <= gap <= LOOP_STALL
        and age <= FRAME_STALE
        and abs(x) <= LIMITS.hard
        and silence <= TELEMETRY_STALE
        and heat < OFF_AT
    )
    assert stops != is_good


CAUSES: dict[str, tuple[dict[str, Any], Severity]] = {
    "stall": ({"tick_gap": 0.5}, HOLD),
    "camera": ({"frame_age": 1.0}, HOLD),
    "lost": ({"tracking": Tracking.LOST}, HOLD),
    "board": ({"board_faults": ("driver_fault",)}, LATCH),
    "line": ({"bad_share": 0.05}, WARN),
    "slow": ({"line_lateness": 0.15}, WARN),
    "sign": ({"turned_away": 1.0}, DISARM),
    "stuck": ({"stuck_age": 1.0}, WARN),
    "heat": ({"is_too_hot": True}, HOLD),
}


@pytest.mark.parametrize(("one", "other"), list(itertools.combinations(CAUSES, 2)))
def test_of_two_causes_the_more_severe_wins_and_clearing_one_keeps_the_other(one: str, other: str) -> None:
    (first, grave), (second, graver) = CAUSES[one], CAUSES[other]
    both = assess(replace(GOOD, **first, **second), LIMITS)
    assert {finding.code for finding in both} == {one, other}
    assert both[0].severity == verdict(both) == max(grave, graver)
    if grave == graver:
        assert both[0].code == one, "equally severe: in the order of the signal's way"
    assert [f.code for f in assess(replace(GOOD, **second), LIMITS)] == [other]
    assert [f.code for f in assess(replace(GOOD, **first), LIMITS)] == [one]


def test_the_severities_are_in_order() -> None:
    assert Severity.OK < WARN < HOLD < DISARM < LATCH
    assert verdict((Finding(WARN, "a", ""), Finding(DISARM, "b", ""), Finding(HOLD, "c", ""))) is DISARM


def test_a_lost_robot_says_why_where_the_tracker_knows() -> None:
    plain = message(tracking=Tracking.LOST)
    assert message(tracking=Tracking.LOST, tracking_reason="it is covered") == f"{plain}: it is covered"
