"""From decisions to the field: leads, shortfalls, and controllers that misbehave."""

import math

import pytest

from control.controllers import Decision, Situation
from control.gait import Gait
from control.model import PIVOT_A, PIVOT_B, Pose, opposite
from control.trajectories import trajectories
from control.walker import SETTLE, STUCK_AFTER, ControllerFault, Moment, Walker

SWEEP = math.radians(30.0)
GAIT = Gait(sweep=SWEEP)
LINE = trajectories.build("line", {})


class Scripted:
    """Says what it is told to say."""

    name = "scripted"

    def __init__(self, answer: object) -> None:
        self.answer = answer

    def step(self, situation: Situation) -> Decision:
        if isinstance(self.answer, Exception):
            raise self.answer
        if self.answer == "alternate":
            pivot = opposite(situation.pivot) if situation.may_switch else situation.pivot
            return Decision(pivot, 1.0 * pivot)
        return self.answer  # type: ignore[return-value]


def walker(answer: object) -> Walker:
    return Walker(Scripted(answer), GAIT, 0.010, PIVOT_A, 0.0)  # type: ignore[arg-type]


def moment(heading: float, now: float = 0.0, settled: bool = False, lead: float = 0.0) -> Moment:
    return Moment(
        now, Pose(0.0, 0.0, heading), (0.0, 0.0), 0.0, LINE, settled, lambda sign: math.copysign(lead, sign)
    )


def test_the_field_leads_the_body_by_the_backlash() -> None:
    stride = walker(Decision(PIVOT_A, 1.0)).step(moment(0.0, lead=0.03))
    assert stride.heading_goal == pytest.approx(SWEEP + 0.03)
    stride = walker(Decision(PIVOT_A, -1.0)).step(moment(0.0, lead=0.03))
    assert stride.heading_goal == pytest.approx(-SWEEP - 0.03)


def test_the_pivot_is_taken_only_when_the_body_has_completed_its_sweep() -> None:
    one = walker("alternate")
    first = one.step(moment(0.0)).pivot
    assert one.step(moment(-0.5 * SWEEP, settled=True)).pivot == first
    assert one.sweep.counts.sweeps == 0
    after = one.step(moment(-SWEEP))
    assert after.pivot == opposite(first)
    assert (one.sweep.counts.steps, one.sweep.counts.sweeps) == (2, 1)


def test_a_body_that_stays_behind_is_pulled_on_by_what_it_misses() -> None:
    one = walker(Decision(PIVOT_A, 1.0))
    one.step(moment(0.0))
    one.step(moment(SWEEP - 0.05, now=1.0, settled=True))
    stride = one.step(moment(SWEEP - 0.05, now=1.0 + SETTLE, settled=True))
    assert stride.heading_goal == pytest.approx(SWEEP + 0.05)


def test_a_body_that_never_comes_is_given_up() -> None:
    one = walker(Decision(PIVOT_B, -1.0))
    one.step(moment(0.0))
    now = 0.0
    for _ in range(2 * (STUCK_AFTER + 1)):
        now += 1.01 * SETTLE
        one.step(moment(0.0, now=now, settled=True))
    assert one.stuck == 1
    assert one.sweep.counts.sweeps == 1


def test_the_rate_is_limited() -> None:
    assert walker(Decision(PIVOT_A, 50.0)).step(moment(0.0)).rate == GAIT.max_rate
    assert walker(Decision(PIVOT_A, -50.0)).step(moment(0.0)).rate == -GAIT.max_rate


@pytest.mark.parametrize(
    "answer",
    [
        ValueError("no"),
        None,
        (PIVOT_A, 1.0),
        Decision(PIVOT_A, math.nan),
        Decision(PIVOT_A, math.inf),
        Decision(0, 1.0),  # type: ignore[arg-type]
        Decision(PIVOT_A, "fast"),  # type: ignore[arg-type]
    ],
)
def test_nonsense_from_a_controller_is_a_named_fault(answer: object) -> None:
    with pytest.raises(ControllerFault, match="scripted"):
        walker(answer).step(moment(0.0))
