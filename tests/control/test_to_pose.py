"""To a pose: from anywhere to a wanted place and heading, with a robot that slips."""

from __future__ import annotations

import math
import random
from collections.abc import Iterator

from hypothesis import given, settings
from hypothesis import strategies as st

from control.controllers import Situation, ToPose
from control.gait import Gait
from control.gait_model import GaitModel
from control.model import PIVOT_A, Pivot, Pose, swing, wrap
from control.trajectories import trajectories

LENGTH = 0.010
EDGE = 0.050
SOFT_MARGIN = 2e-3
SLIP = GaitModel(LENGTH, out=-0.15e-3, forward_base=0.1e-3, forward_per_sweep=0.4e-3)
"""About what the slip table has at 25 degrees of tilt."""
SCATTER, TURN_SCATTER = 0.07e-3, math.radians(1.0)
"""Of a pivot switch, m, and of the end of a sweep, rad."""
LINE = trajectories.build("line", {})

places = st.floats(-EDGE, EDGE)
poses = st.builds(Pose, places, places, st.floats(-math.pi, math.pi))


class SlippingRobot:
    """Makes whole sweeps; slips at each switch, by the mean and by chance."""

    def __init__(self, pose: Pose, slip: GaitModel, chance: random.Random | None) -> None:
        self.pose = pose
        self._slip = slip
        self._chance = chance
        self._pivot: Pivot = PIVOT_A
        self._turned = 0.0

    def walk(self, controller: ToPose, known: GaitModel | None) -> Iterator[Pose]:
        """Its pose after each sweep, until the controller has finished. known: what it is told of the slip."""
        while True:
            situation = Situation(
                self.pose, self._pivot, True, 0.0, (0.0, 0.0), LINE, 0.0, Gait(), LENGTH, EDGE, known
            )
            decision = controller.step(situation)
            if decision.finished:
                return
            assert decision.sweep is not None
            self._take(decision.pivot)
            self._turn(math.copysign(decision.sweep, decision.rate))
            yield self.pose

    def _take(self, pivot: Pivot) -> None:
        if pivot != self._pivot:
            pose = self._slip.landed(self.pose, self._pivot, self._turned)
            self.pose = Pose(pose.x + self._by(SCATTER), pose.y + self._by(SCATTER), pose.heading)
            self._pivot, self._turned = pivot, 0.0

    def _turn(self, angle: float) -> None:
        angle += self._by(TURN_SCATTER)
        self.pose = swing(self.pose, self._pivot, angle, LENGTH)
        self._turned += angle

    def _by(self, deviation: float) -> float:
        return 0.0 if self._chance is None else self._chance.gauss(0.0, deviation)


def to(goal: Pose) -> ToPose:
    place = {"x_mm": goal.x * 1e3, "y_mm": goal.y * 1e3, "heading_deg": math.degrees(goal.heading)}
    return ToPose(ToPose.Parameters(**place))


def is_there(pose: Pose, goal: Pose) -> bool:
    turn = abs(math.degrees(wrap(pose.heading - goal.heading)))
    return pose.distance_to(goal.x, goal.y) <= 0.5e-3 and turn <= 3.0


@settings(max_examples=12, deadline=None)
@given(poses, poses, st.integers(0, 1000))
def test_a_slipping_robot_comes_from_anywhere_to_any_pose_inside_the_workspace(
    start: Pose, goal: Pose, seed: int
) -> None:
    robot = SlippingRobot(start, SLIP, random.Random(seed))
    way = list(robot.walk(to(goal), SLIP))
    assert is_there(robot.pose, goal)
    distance = start.distance_to(goal.x, goal.y)
    assert len(way) <= 25 + 2.0 * distance / (LENGTH * math.sin(math.radians(20.0))), "no detours"
    assert all(max(abs(pose.x), abs(pose.y)) <= EDGE + SOFT_MARGIN for pose in way)


@settings(max_examples=8, deadline=None)
@given(poses, st.floats(-5e-3, 5e-3), st.floats(-5e-3, 5e-3), st.floats(-0.8, 0.8))
def test_what_nobody_told_it_of_the_slip_it_learns_on_the_way(
    goal: Pose, dx: float, dy: float, turn: float
) -> None:
    start = Pose(goal.x * 0.8 + dx, goal.y * 0.8 + dy, goal.heading + turn)
    goal = Pose(goal.x * 0.8, goal.y * 0.8, goal.heading)
    robot = SlippingRobot(start, SLIP, random.Random(1))
    assert len(list(robot.walk(to(goal), None))) <= 40
    assert is_there(robot.pose, goal)


def test_a_robot_that_is_there_stays_there() -> None:
    goal = Pose(0.01, -0.02, 1.0)
    robot = SlippingRobot(goal, SLIP, None)
    assert list(robot.walk(to(goal), SLIP)) == []


def test_a_robot_that_only_slides_gives_up_at_last() -> None:
    """Each switch throws it back by as much as a sweep gains."""
    ice = GaitModel(LENGTH, forward_base=-LENGTH * math.sin(math.radians(20.0)))
    robot = SlippingRobot(Pose(-0.02, 0.0, 0.0), ice, None)
    way = list(robot.walk(to(Pose(0.02, 0.0, 0.0)), None))
    assert len(way) <= 60 + 3.0 * 0.04 / (LENGTH * math.sin(math.radians(20.0))) + 1


def test_a_place_sideways_is_reached_as_a_car_parks() -> None:
    robot = SlippingRobot(Pose(0.0, 2e-3, 0.0), GaitModel(LENGTH), None)
    way = list(robot.walk(to(Pose(0.0, 0.0, 0.0)), None))
    assert is_there(robot.pose, Pose(0.0, 0.0, 0.0))
    assert len(way) <= 6
