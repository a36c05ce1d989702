"""Sweeps, and the walk that they make."""

import itertools
import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from control.controllers import Decision, Situation, controllers
from control.gait import Gait, Sweep, advance_of_sweep
from control.model import PIVOT_A, PIVOT_B, Pose, opposite
from control.simulation.kinematic import KinematicWalker, walk
from control.trajectories import trajectories

LENGTH = 0.010


class Alternating:
    """Walks straight on: the other pivot and the other direction at each completed sweep."""

    name = "alternating"

    def __init__(self, rate: float) -> None:
        self.rate = rate
        self.switch_headings: list[float] = []

    def step(self, situation: Situation) -> Decision:
        if not situation.may_switch:
            return Decision(situation.pivot, self.rate * situation.pivot)
        self.switch_headings.append(situation.pose.heading)
        pivot = opposite(situation.pivot)
        return Decision(pivot, self.rate * pivot)


def walker(sweep: float, rate: float, start_heading: float = 0.0) -> KinematicWalker:
    return KinematicWalker(
        Alternating(rate),  # type: ignore[arg-type]
        trajectories.build("line", {}),
        Gait(sweep=sweep, max_rate=10.0),
        Pose(0.0, 0.0, start_heading),
        LENGTH,
    )


@given(st.floats(0.02, 6.0), st.floats(0.1, 9.0), st.floats(0.001, 0.5))
@settings(deadline=None)
def test_sweeps_end_exactly_at_the_sweep_angle_whatever_the_tick(
    sweep: float, rate: float, tick: float
) -> None:
    one = walker(sweep, rate)
    walk(one, min(40 * tick, 20.0), tick)
    headings = one.controller.switch_headings  # type: ignore[attr-defined]
    for earlier, later in itertools.pairwise(headings):
        assert abs(later - earlier) == pytest.approx(sweep, abs=1e-9)


@pytest.mark.parametrize("sweep_deg", [1, 10, 30, 90, 150])
def test_each_full_sweep_advances_the_centre_by_l_sin_half_sweep(sweep_deg: float) -> None:
    sweep = math.radians(sweep_deg)
    one = walker(sweep, 1.0, start_heading=sweep / 2)
    walk(one, 10 * sweep, sweep)
    assert math.hypot(one.pose.x, one.pose.y) == pytest.approx(10 * advance_of_sweep(sweep, LENGTH), rel=1e-9)


def test_steps_count_switches_of_the_pivot_and_nothing_else() -> None:
    sweep = Sweep(0.5, PIVOT_A, 0.0)
    sweep.choose(PIVOT_A)
    sweep.complete(0.5)
    sweep.choose(PIVOT_B)
    assert (sweep.counts.steps, sweep.counts.sweeps) == (1, 1)


def test_reversals_count_changes_of_sign_across_standstill() -> None:
    sweep = Sweep(0.5, PIVOT_A, 0.0)
    for rate in (1.0, 0.0, 2.0, -1.0, 0.0, -0.5, 0.3):
        sweep.turning(rate)
    assert sweep.counts.reversals == 2


def test_what_remains_of_a_sweep_depends_on_the_direction() -> None:
    sweep = Sweep(0.5, PIVOT_A, 1.0)
    assert sweep.remaining(1.2, 1.0) == pytest.approx(0.3)
    assert sweep.remaining(1.2, -1.0) == pytest.approx(0.7)
    assert sweep.remaining(1.7, 1.0) == 0.0


def test_the_reference_runs_with_the_path_step() -> None:
    assert Gait(path_step=0.3).reference_speed == pytest.approx(3.0)


def test_geometric_keeps_the_active_pivot_on_a_tie() -> None:
    geometric = controllers.build("geometric", {})
    for pivot in (PIVOT_A, PIVOT_B):
        decision = geometric.step(
            Situation(
                pose=Pose(0.0, 0.0, 0.0), pivot=pivot, may_switch=True, turned=0.0, reference=(0.02, 0.0),
                trajectory=trajectories.build("line", {}), reference_time=0.0, gait=Gait(), length=LENGTH,
            )
        )  # fmt: skip
        assert decision.pivot == pivot
        assert decision.rate == pytest.approx(pivot * 300.0 * 0.02)
