"""The planner's walks in pure kinematics, against the geometric controller and its own promises."""

import math
import random

import pytest
from planning_bench import Still, best_geometric, one_eight, walker

from control.controllers import Controller, Decision, Situation
from control.gait import Gait
from control.model import PIVOT_A, PIVOT_B, Pose, wrap
from control.simulation.kinematic import walk
from control.simulation.trade_off import PAPER_START, error_over_sweeps
from control.trajectories import trajectories
from control.trajectories.eight import PAPER_PERIOD
from control.walker import ControllerFault, Moment, Walker

APPROACHED = 30
"""Ticks after which the robot has come from its start to the path."""


@pytest.mark.parametrize(("sweep", "share", "paper_sweeps"), [(10.0, 0.1, 437), (30.0, 1.0 / 3.5, 167)])
def test_it_beats_the_geometric_controller_by_far_with_hardly_more_sweeps(
    sweep: float, share: float, paper_sweeps: int
) -> None:
    metrics = one_eight("planner", sweep)
    assert metrics.mean_error <= share * best_geometric(sweep)
    assert metrics.sweeps <= 1.3 * paper_sweeps
    assert 0 < metrics.steps <= metrics.sweeps + 1
    assert metrics.reversals > 0


def test_sweeps_that_may_end_early_follow_the_path_within_a_tenth_of_a_millimetre() -> None:
    eight = trajectories.build("eight", {})
    poses = walk(walker("planner", 30.0, {"early_end": True}, eight), PAPER_PERIOD).poses
    errors = [pose.distance_to(*eight.point(index * 0.1)) for index, pose in enumerate(poses)]
    assert sum(errors[APPROACHED:]) / len(errors[APPROACHED:]) <= 1e-4


class Recorded:
    """Passes the decisions of another controller on and keeps them."""

    def __init__(self, inner: Controller) -> None:
        self.name = inner.name
        self._inner = inner
        self.decisions: list[tuple[Situation, Decision]] = []

    def step(self, situation: Situation) -> Decision:
        decision = self._inner.step(situation)
        self.decisions.append((situation, decision))
        return decision


def record(parameters: dict[str, object], seconds: float = 30.0) -> list[tuple[Situation, Decision]]:
    one = walker("planner", 30.0, parameters, trajectories.build("eight", {}))
    recorded = Recorded(one.controller)
    one.controller = recorded  # type: ignore[assignment]
    walk(one, seconds)
    return recorded.decisions


def test_without_leave_to_end_early_every_sweep_is_whole_and_keeps_its_pivot() -> None:
    for situation, decision in record({}):
        assert decision.sweep in (None, pytest.approx(situation.gait.sweep))
        assert abs(decision.rate) <= situation.gait.max_rate + 1e-9
        assert situation.may_switch or decision.pivot == situation.pivot


def test_with_leave_to_end_early_no_sweep_is_longer_than_the_gaits() -> None:
    sweeps = {
        round(math.degrees(decision.sweep), 1)
        for _, decision in record({"early_end": True})
        if decision.sweep
    }
    assert max(sweeps) <= 30.0
    assert len(sweeps) > 1


def test_a_dearer_switch_buys_fewer_switches_for_a_larger_error() -> None:
    cheap, dear = error_over_sweeps(math.radians(10.0), weights=(0.0, 0.1))
    assert dear.switches < 0.7 * cheap.switches
    assert dear.mean_error > cheap.mean_error


def test_it_never_steps_out_of_the_workspace() -> None:
    edge = 0.030
    one = walker(
        "planner", 30.0, {}, trajectories.build("circle", {"radius_mm": 32.0}), Pose(0.0, -0.025, 0.0)
    )
    one.workspace = edge
    for index in range(700):
        one.advance(index * 0.1, 0.1)
        if one.sweep.turned(one.pose.heading) == 0.0:
            assert max(abs(one.pose.x), abs(one.pose.y)) <= edge + 1e-5
        assert max(abs(one.pose.x), abs(one.pose.y)) <= edge + 5e-4, "the bulge of an arc"


@pytest.mark.parametrize("sweep", [10.0, 30.0])
def test_it_brings_the_robot_to_a_place_and_heading_and_holds_it(sweep: float, full: bool) -> None:
    rng = random.Random(1)
    for _ in range(16 if full else 5):
        x, y = rng.uniform(-0.015, 0.015), rng.uniform(-0.015, 0.015)
        heading = rng.uniform(-180.0, 180.0)
        parameters = {"early_end": True, "heading": "fixed", "heading_deg": heading}
        one = walker("planner", sweep, parameters, Still(x, y), Pose(0.0, 0.0, 0.0))
        for index in range(200):
            one.advance(index * 0.1, 0.1)
            if index >= 100:
                assert one.pose.distance_to(x, y) <= 0.5e-3
                assert abs(wrap(one.pose.heading - math.radians(heading))) <= math.radians(sweep)


def test_a_gait_that_changes_on_the_way_is_taken_up_at_once() -> None:
    one = walker("planner", 10.0, {}, trajectories.build("eight", {}), PAPER_START)
    for index in range(100):
        one.advance(index * 0.1, 0.1)
    one.gait = Gait(sweep=math.radians(30.0))
    for index in range(100, 300):
        one.advance(index * 0.1, 0.1)
    assert one.pose.distance_to(*one.reference.point) < 3e-3


def test_it_takes_over_from_another_controller_in_the_middle_of_a_sweep() -> None:
    eight = trajectories.build("eight", {})
    one = walker("geometric", 30.0, {}, eight)
    for index in range(55):
        one.advance(index * 0.1, 0.1)
    assert one.sweep.turned(one.pose.heading) != 0.0
    one.controller = walker("planner", 30.0, {}, eight).controller
    for index in range(55, 155):
        one.advance(index * 0.1, 0.1)
    assert one.pose.distance_to(*one.reference.point) < 2e-3


class Saying:
    """Says what it is told to say."""

    name = "saying"

    def __init__(self, decision: Decision) -> None:
        self.decision = decision

    def step(self, situation: Situation) -> Decision:  # noqa: ARG002 (the controller's signature)
        return self.decision


def moment(heading: float) -> Moment:
    pose = Pose(0.0, 0.0, heading)
    return Moment(0.0, pose, (0.0, 0.0), 0.0, Still(0.0, 0.0), False, lambda _: 0.0)


def rig_walker(decision: Decision) -> Walker:
    return Walker(Saying(decision), Gait(sweep=0.5), 0.010, PIVOT_A, 0.0)  # type: ignore[arg-type]


def test_the_field_of_a_sweep_that_ends_early_stops_there() -> None:
    one = rig_walker(Decision(PIVOT_A, 1.0, sweep=0.2))
    assert one.step(moment(0.0)).heading_goal == pytest.approx(0.2)
    one.step(moment(0.2))
    assert one.sweep.counts.sweeps == 1


def test_a_robot_that_waits_may_still_choose_its_pivot() -> None:
    one = rig_walker(Decision(PIVOT_A, 0.0))
    one.step(moment(0.0))
    one.controller.decision = Decision(PIVOT_B, -1.0)  # type: ignore[attr-defined]
    assert one.step(moment(0.0)).pivot == PIVOT_B


@pytest.mark.parametrize("sweep", [0.0, -0.1, math.nan, math.inf, 7.0, "half"])
def test_a_sweep_that_is_none_is_a_named_fault(sweep: object) -> None:
    with pytest.raises(ControllerFault, match="saying"):
        rig_walker(Decision(PIVOT_A, 1.0, sweep=sweep)).step(moment(0.0))  # type: ignore[arg-type]


def test_a_faster_path_that_is_chosen_on_the_way_is_followed_as_if_it_had_been_the_first() -> None:
    slow, fast = (trajectories.build("line", {"speed_mm_s": speed}) for speed in (0.5, 6.0))
    begun = walker("planner", 30.0, {}, slow, Pose(0.0, -0.04, math.pi / 2))
    walk(begun, 5.3)
    known, fresh = (walker("planner", 30.0, {}, fast, begun.pose) for _ in range(2))
    known.controller = begun.controller
    errors = [walk(one, 10.0).metrics.mean_error for one in (known, fresh)]
    assert errors[0] == pytest.approx(errors[1], rel=0.2)
