"""What is told of a fault: the promise, and what a rig in simulated time did about it."""

import math

import pytest

from control.news import Announcement
from control.simulation.faults.promises import PROMISES
from control.snapshot import RigState
from server.fault_watch import ALLOWANCE, CARRIED_ON, Reaction, Verdict, cause_of

DECAY = 0.15


def reaction(name: str, became: RigState | None, zero: float | None = 0.2, **more: object) -> Reaction:
    given = {"since": 10.0, "was": RigState.RUNNING, "is_usual": True, "decay": DECAY, **more}
    return Reaction(name, became=became, changed=None if became is None else 0.1, zero=zero, **given)  # type: ignore[arg-type]


def line(code: str, after: float) -> Announcement:
    return Announcement(10.0 + after, "error", code, "what is wrong")


def test_a_promise_is_kept_when_state_cause_and_times_are_as_promised() -> None:
    held = reaction("camera_unplugged", RigState.HELD)
    assert held.judge(line("camera", 0.101), 11.0) is Verdict.KEPT


@pytest.mark.parametrize(
    ("became", "code", "noticed", "zero"),
    [
        (RigState.HELD, "camera", 0.104 + 1.1 * ALLOWANCE, 0.2),
        (RigState.HELD, "camera", 0.101, 0.105 + DECAY + 1.1 * ALLOWANCE),
        (RigState.FAULT, "camera", 0.101, 0.2),
    ],
)
def test_a_promise_is_broken_by_each_of_them(
    became: RigState, code: str, noticed: float, zero: float
) -> None:
    assert reaction("camera_unplugged", became, zero).judge(line(code, noticed), 11.0) is Verdict.BROKEN


def test_a_rig_that_stops_for_another_reason_has_shown_nothing_of_this_fault() -> None:
    assert reaction("camera_unplugged", RigState.FAULT).judge(line("estop", 0.05), 11.0) is Verdict.OPEN
    assert reaction("camera_unplugged", RigState.HELD).judge(line("stale", 0.05), 11.0) is Verdict.OPEN


def test_current_that_never_goes_breaks_the_promise() -> None:
    held = reaction("camera_unplugged", RigState.HELD, None)
    assert held.judge(line("camera", 0.1), 11.0) is Verdict.WATCHING
    held.is_over = True
    assert held.judge(line("camera", 0.1), 20.0) is Verdict.BROKEN


def test_a_rig_that_should_stop_and_walks_on_breaks_its_promise() -> None:
    walking = reaction("camera_unplugged", None, None)
    assert walking.judge(None, 10.05) is Verdict.WATCHING
    assert walking.judge(None, 10.0 + 1.1 * CARRIED_ON) is Verdict.BROKEN


def test_a_rig_that_promises_to_walk_on_keeps_that_by_walking_on() -> None:
    walking = reaction("debris", None, None)
    assert walking.judge(None, 10.5) is Verdict.WATCHING
    assert walking.judge(None, 10.0 + 1.1 * CARRIED_ON) is Verdict.KEPT
    assert reaction("debris", RigState.HELD).judge(line("lost", 0.2), 11.0) is Verdict.BROKEN


def test_where_the_promise_is_for_another_case_nothing_is_said_of_it() -> None:
    unusual = reaction("camera_late", None, None, is_usual=False)
    assert unusual.judge(None, 10.0 + 1.1 * CARRIED_ON) is Verdict.OPEN
    standing = reaction("coil_swapped", None, None, was=RigState.ARMED)
    assert standing.judge(None, 10.0 + 1.1 * CARRIED_ON) is Verdict.OPEN
    resting = reaction("camera_unplugged", None, was=RigState.DISARMED)
    assert resting.judge(None, 11.0) is Verdict.AT_REST


def test_a_hanging_controller_is_met_as_the_watchdog_leaves_it() -> None:
    hung = reaction("controller_hangs", RigState.FAULT)
    assert hung.judge(line("controller", 0.5), 14.0) is Verdict.KEPT


def test_the_cause_is_the_first_error_after_the_fault() -> None:
    lines = [
        line("before", -0.1),
        Announcement(10.0, "warn", "injected", ""),
        line("camera", 0.1),
        line("lost", 0.2),
    ]
    cause = cause_of(reaction("camera_unplugged", RigState.HELD), lines)
    assert cause is not None
    assert cause.code == "camera"


def test_every_promise_can_be_told() -> None:
    for promise in PROMISES.values():
        assert promise.sees
        assert promise.states
        assert (promise.noticed is None) is (promise.zero is None)
        assert math.isfinite(promise.zero or 0)
