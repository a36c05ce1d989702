"""Section 3 of the paper: straight walking in closed form, against the controller that walks it."""

import math

import pytest

from control.controllers import controllers
from control.gait import Gait, detour, steps_for_distance
from control.model import Pose
from control.simulation.kinematic import KinematicWalker
from control.trajectories import trajectories

LENGTH = 0.010
DISTANCE = 0.060
HEADING = 0.7
COARSE, FINE = 100.0, 0.004


def walked(sweep: float, rate_deg_s: float = 100.0, tick: float = COARSE) -> tuple[KinematicWalker, float]:
    """The walker at the end of its way, and the way of its centre as seen once a tick (s), m."""
    straight = controllers.build("straight", {"distance_mm": DISTANCE * 1e3, "rate_deg_s": rate_deg_s})
    gait = Gait(sweep=sweep, max_rate=10.0)
    walker = KinematicWalker(straight, trajectories.build("line", {}), gait, Pose(0.0, 0.0, HEADING), LENGTH)
    travelled = 0.0
    while not walker.is_finished:
        before = walker.pose
        walker.advance(0.0, tick)
        travelled += walker.pose.distance_to(before.x, before.y)
    return walker, travelled


@pytest.mark.parametrize(("sweep_deg", "steps"), [(10, 70), (30, 24), (90, 9), (180, 7), (300, 13)])
def test_the_papers_60_mm_take_this_many_steps(sweep_deg: float, steps: int) -> None:
    assert steps_for_distance(DISTANCE, math.radians(sweep_deg), LENGTH) == steps


def test_the_closed_form_counts_what_the_controller_walks_at_every_sweep() -> None:
    for sweep_deg in range(1, 360):
        sweep = math.radians(sweep_deg)
        walker, _ = walked(sweep)
        expected = steps_for_distance(DISTANCE, sweep, LENGTH)
        assert (walker.sweep.counts.steps, walker.sweep.counts.sweeps) == (expected, expected), sweep_deg


def test_the_walk_is_straight_and_ends_with_the_step_that_completes_the_distance() -> None:
    for sweep_deg in (10, 30, 90, 180, 300):
        sweep = math.radians(sweep_deg)
        walker, travelled = walked(sweep, tick=FINE)
        along = walker.pose.x * math.cos(HEADING) + walker.pose.y * math.sin(HEADING)
        advance = LENGTH * math.sin(sweep / 2.0)
        assert DISTANCE - 1e-9 <= along < DISTANCE + advance + 1e-9
        assert travelled == pytest.approx(along * detour(sweep), rel=1e-4)


def test_the_walk_does_not_depend_on_the_rate() -> None:
    slow, _ = walked(math.radians(30.0), rate_deg_s=7.0)
    quick, _ = walked(math.radians(30.0), rate_deg_s=300.0)
    assert (slow.pose.x, slow.pose.y) == pytest.approx((quick.pose.x, quick.pose.y), abs=1e-9)
    assert slow.sweep.counts.steps == quick.sweep.counts.steps


def test_fewest_steps_are_needed_near_180_degrees_and_a_small_sweep_takes_no_detour() -> None:
    steps = {deg: steps_for_distance(DISTANCE, math.radians(deg), LENGTH) for deg in range(1, 360)}
    assert min(steps, key=lambda deg: (steps[deg], abs(deg - 180))) == 180
    assert steps[1] > 600
    assert steps[359] > 600
    assert detour(math.radians(1.0)) == pytest.approx(1.0, abs=2e-5)
    assert detour(math.pi) == pytest.approx(math.pi / 2.0)
