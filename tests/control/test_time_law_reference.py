"""The reference that waits for the robot, the approach to a path, and changes on the way."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from control.controllers import controllers
from control.gait import Gait, TimeLaw
from control.model import Pose
from control.simulation.kinematic import KinematicWalker, walk
from control.trajectories import Path, trajectories
from control.trajectories.reference import Reference

LENGTH = 0.010
TICK = 1.0 / 60.0
EIGHT = trajectories.build("eight", {})
LINE = trajectories.build("line", {})
CIRCLE = trajectories.build("circle", {})
SQUARE = trajectories.build("waypoints", {})
WAIT = Gait(time_law=TimeLaw.WAIT, speed=0.004, wait_distance=0.005)
RESOLUTION = 0.005 / 16.0
"""How exactly the nearest point of the path is found at this waiting distance, m."""

patient = settings(max_examples=60, deadline=None)


def at(point: tuple[float, float]) -> Pose:
    return Pose(*point, 0.0)


def ahead_of(path: Path, reference: Reference) -> float:
    """How far along its path the reference has come, m."""
    return reference.path_time / path.duration * 0.080


def walked(path: Path, gait: Gait, start: Pose, duration: float) -> KinematicWalker:
    walker = KinematicWalker(controllers.build("geometric", {}), path, gait, start, LENGTH)
    walk(walker, duration)
    return walker


def test_the_reference_waits_for_a_robot_that_stands_still() -> None:
    reference = Reference(LINE, WAIT)
    for tick in range(600):
        reference.advance_to(tick * TICK, at((0.0, -0.040)))
    assert ahead_of(LINE, reference) == pytest.approx(0.005, abs=RESOLUTION)
    assert reference.duration == pytest.approx(20.0 + 599 * TICK - reference.time)


def test_the_reference_walks_at_its_speed_before_a_robot_that_follows() -> None:
    reference = Reference(EIGHT, WAIT)
    for tick in range(600):
        reference.advance_to(tick * TICK, at(reference.point))
    assert reference.time == pytest.approx(599 * TICK)


def test_the_reference_is_no_faster_for_a_robot_that_is_ahead() -> None:
    reference = Reference(LINE, WAIT)
    for tick in range(600):
        reference.advance_to(tick * TICK, at((0.0, 0.040)))
    assert reference.time <= 599 * TICK


def test_a_robot_that_is_carried_away_is_waited_for_where_it_was() -> None:
    reference = Reference(EIGHT, WAIT)
    for tick in range(600):
        reference.advance_to(tick * TICK, at(reference.point))
    before = reference.point
    for tick in range(600, 1200):
        reference.advance_to(tick * TICK, at((0.055, 0.055)))
    assert reference.point == before


def test_a_robot_in_the_middle_of_a_circle_follows_none_of_it() -> None:
    reference = Reference(CIRCLE, WAIT)
    rng = np.random.default_rng(1)
    for tick in range(600):
        x, y = rng.normal(0.0, 1e-4, 2)
        reference.advance_to(tick * TICK, Pose(x, y, 0.0))
    assert reference.time == 0.0


def test_at_a_crossing_the_reference_does_not_take_another_branch() -> None:
    """The eight crosses itself in its centre; a robot that stays there is passed once, and then waited for."""
    reference = Reference(EIGHT, WAIT)
    for tick in range(6000):
        robot = reference.point if math.hypot(*reference.point) > 1e-3 else (0.0, 0.0)
        reference.advance_to(tick * TICK, at(robot))
        if robot == (0.0, 0.0):
            break
    for tick in range(6000, 9000):
        reference.advance_to(tick * TICK, at((0.0, 0.0)))
    assert math.hypot(*reference.point) <= 0.005 + RESOLUTION


@patient
@given(
    st.lists(
        st.tuples(st.floats(-0.06, 0.06), st.floats(-0.06, 0.06), st.floats(0.0, 0.2)),
        min_size=1,
        max_size=40,
    )
)
def test_the_reference_never_goes_back_and_never_hurries(moves: list[tuple[float, float, float]]) -> None:
    reference = Reference(EIGHT, WAIT)
    elapsed = 0.0
    for x, y, dt in moves:
        before = reference.time
        elapsed += dt
        reference.advance_to(elapsed, Pose(x, y, 0.0))
        assert 0.0 <= reference.time - before <= dt + 1e-12


@pytest.mark.parametrize("path", [EIGHT, SQUARE])
def test_a_slow_robot_is_waited_for_all_along_its_path(path: Path) -> None:
    """At a quarter of the speed it would need, it still walks the whole path, and stays near it."""
    gait = Gait(math.radians(20.0), max_rate=0.3, time_law=TimeLaw.WAIT, speed=0.010, wait_distance=0.004)
    walker = walked(path, gait, Pose(*path.point(0.0), math.pi / 2), 200.0)
    plain = walked(path, Gait(gait.sweep, max_rate=0.3, path_step=0.33), Pose(*path.point(0.0), 1.57), 200.0)
    assert walker.pose.distance_to(*walker.reference.point) < 0.004 + LENGTH / 2
    assert 0.3 < walker.reference.passes_done < plain.reference.passes_done


def test_the_approach_is_a_straight_line_at_the_pace_of_the_path() -> None:
    gait = Gait(time_law=TimeLaw.CONSTANT_SPEED, speed=0.004)
    reference = Reference(CIRCLE, gait, start=(0.024, -0.035 + 0.032))
    points = []
    for tick in range(11):
        reference.advance_to(float(tick), at(reference.point))
        points.append(reference.point)
        assert reference.is_approaching == (tick < 10)
        assert reference.passes_done == 0.0
    expected = [(0.0024 * k, -0.035 + 0.0032 * k) for k in range(10, -1, -1)]
    assert np.array(points) == pytest.approx(np.array(expected), abs=1e-12)
    assert reference.duration == pytest.approx(10.0 + 2.0 * math.pi * 0.035 / 0.004, rel=1e-5)


def test_the_paths_own_clock_starts_when_the_approach_ends() -> None:
    reference = Reference(EIGHT, Gait(), start=(0.010, -0.040))
    lead = 0.010 / (0.377177 / 125.663706)
    reference.advance_to(lead + 20.0, at((0.0, 0.0)))
    assert reference.point == pytest.approx(EIGHT.point(20.0), abs=1e-6)
    assert reference.passes_done == pytest.approx(20.0 / 125.663706, abs=1e-5)


def test_a_robot_at_the_start_has_no_approach() -> None:
    reference = Reference(EIGHT, Gait(), start=EIGHT.point(0.0))
    assert not reference.is_approaching
    assert reference.duration == pytest.approx(EIGHT.duration)


def test_errors_count_from_the_start_of_the_path() -> None:
    start = Pose(0.030, -0.040, math.pi / 2)
    robot = controllers.build("geometric", {"gain": 2.5})
    gait = Gait(math.radians(10.0), approach=True, time_law=TimeLaw.CONSTANT_SPEED, speed=0.003)
    result = walk(KinematicWalker(robot, EIGHT, gait, start, LENGTH), 20.0).metrics
    assert result.ticks == 101
    assert result.max_error < 0.005
    without = walk(KinematicWalker(robot, EIGHT, Gait(gait.sweep), start, LENGTH), 20.0).metrics
    assert without.ticks == 200
    assert without.max_error > 0.025


def test_a_reference_that_waits_also_waits_on_the_approach() -> None:
    gait = Gait(time_law=TimeLaw.WAIT, speed=0.004, wait_distance=0.005)
    reference = Reference(EIGHT, gait, start=(0.030, -0.040))
    for tick in range(1200):
        reference.advance_to(tick * TICK, at((0.030, -0.040)))
    assert reference.is_approaching
    assert reference.point == pytest.approx((0.025, -0.040), abs=RESOLUTION)


gaits = st.builds(
    Gait,
    time_law=st.sampled_from(list(TimeLaw)),
    path_step=st.floats(0.02, 0.9),
    speed=st.floats(1e-3, 0.02),
    approach=st.booleans(),
)


@patient
@given(gaits, gaits, st.floats(0.0, 30.0))
def test_another_gait_on_the_way_does_not_move_the_reference(one: Gait, other: Gait, elapsed: float) -> None:
    reference = Reference(EIGHT, one)
    reference.advance_to(elapsed, at(EIGHT.point(0.0)))
    assume(not reference.is_over)  # a run that is over has ended and is changed no more
    before, done = reference.point, reference.passes_done
    reference.change(other)
    assert reference.point == pytest.approx(before, abs=1e-7)
    reference.advance_to(elapsed, at(before))
    assert reference.point == pytest.approx(before, abs=1e-7)
    assert reference.passes_done == pytest.approx(done, abs=1e-6)


@patient
@given(gaits)
def test_another_gait_goes_on_with_the_approach_from_where_the_reference_is(other: Gait) -> None:
    reference = Reference(EIGHT, Gait(approach=True), start=(0.030, -0.040))
    reference.advance_to(5.0, at((0.03, -0.04)))
    before = reference.point
    reference.change(other)
    assert reference.is_approaching == other.approach
    expected = before if other.approach else EIGHT.point(0.0)
    assert reference.point == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("law", list(TimeLaw))
@pytest.mark.parametrize("passes", [0.05, 1.0, 2.0])
def test_every_walk_comes_to_its_end(law: TimeLaw, passes: float) -> None:
    for path in (EIGHT, LINE):
        reference = Reference(path, Gait(time_law=law, speed=0.02), passes)
        elapsed = 0.0
        while not reference.is_over:
            elapsed += 0.1
            assert elapsed < 500.0
            reference.advance_to(elapsed, at(reference.point))
        assert elapsed == pytest.approx(reference.duration, abs=0.11)
