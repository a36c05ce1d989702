"""The optimization controller: its gradient, its descent, and what they are worth on the paper's eight."""

import math
import random

import pytest
from planning_bench import best_geometric, one_eight, walker

from control.controllers.gradient import (
    CONVERGED,
    Cost,
    cost_by_rate,
    cost_value,
    descend,
    is_other_lower,
    look_ahead,
    lowest_on,
)
from control.gait import Gait
from control.model import Pivot, Pose, opposite, wrap
from control.trajectories import trajectories

RNG = random.Random(4)
COSTS = [
    Cost(
        x=RNG.uniform(-0.05, 0.05),
        y=RNG.uniform(-0.05, 0.05),
        heading=RNG.uniform(-7.0, 7.0),
        half=0.005,
        look_ahead=RNG.uniform(0.3, 1.2),
        desired_x=RNG.uniform(-0.05, 0.05),
        desired_y=RNG.uniform(-0.05, 0.05),
        wanted=RNG.uniform(-3.0, 3.0),
        weight=RNG.choice([0.0, 1e-5, 1e-4]),
    )
    for _ in range(200)
]
MAX_RATE = 2.0


@pytest.mark.parametrize("sigma", [1.0, -1.0])
def test_the_analytic_gradient_is_the_finite_difference(sigma: float) -> None:
    step = 1e-6
    for cost in COSTS:
        rate = RNG.uniform(-MAX_RATE, MAX_RATE)
        change = cost_value(cost, rate + step, sigma) - cost_value(cost, rate - step, sigma)
        assert cost_by_rate(cost, rate, sigma) == pytest.approx(0.5 * change / step, abs=1e-9)


def near(cost: Cost, sigma: float) -> Cost:
    """The same robot with its desired point within reach: on its arc, a little off."""
    pivot_x = cost.x - sigma * cost.half * math.sin(cost.heading)
    pivot_y = cost.y + sigma * cost.half * math.cos(cost.heading)
    after = cost.heading + 0.4
    reach = 1.05 * sigma * cost.half
    x, y = pivot_x + reach * math.sin(after), pivot_y - reach * math.cos(after)
    return cost._replace(desired_x=x, desired_y=y, weight=0.0)


@pytest.mark.parametrize("sigma", [1.0, -1.0])
def test_the_descent_ends_where_the_gradient_vanishes(sigma: float) -> None:
    for cost in (near(cost, sigma) for cost in COSTS):
        rate = descend(cost, sigma, 0.0, 10.0)
        assert rate * cost.look_ahead == pytest.approx(0.4, abs=2.0 * CONVERGED)


def test_the_descent_never_leaves_the_limits_and_never_climbs() -> None:
    for cost in COSTS:
        for start in (-0.3, 0.3):
            rate = descend(cost, 1.0, start, MAX_RATE)
            assert -MAX_RATE <= rate <= MAX_RATE
            assert cost_value(cost, rate, 1.0) <= cost_value(cost, start, 1.0) + 1e-12


def chosen(cost: Cost, pivot: Pivot) -> tuple[Pivot, float]:
    """What the law takes where it may: pivot and rate, rad/s."""
    lowest, rate = lowest_on(cost, pivot, MAX_RATE)
    end, other_rate = lowest_on(cost, opposite(pivot), MAX_RATE)
    return (opposite(pivot), other_rate) if is_other_lower(end, lowest, pivot) else (pivot, rate)


@pytest.mark.parametrize("pivot", [1, -1])
@pytest.mark.parametrize("bearing", [0.0, 0.5 * math.pi, -0.5 * math.pi, math.pi])
def test_what_lies_symmetrically_is_not_told_apart_by_the_last_digits(bearing: float, pivot: Pivot) -> None:
    for cost in COSTS:
        x = cost.x + 0.003 * math.cos(cost.heading + bearing)
        y = cost.y + 0.003 * math.sin(cost.heading + bearing)
        cost = cost._replace(desired_x=x, desired_y=y, weight=0.0)
        expected = chosen(cost, pivot)
        for heading in (cost.heading - 1e-14, cost.heading + 1e-14):
            taken, rate = chosen(cost._replace(heading=heading), pivot)
            assert (taken, rate) == (expected[0], pytest.approx(expected[1], abs=1e-9))


def test_the_look_ahead_follows_from_the_sweep() -> None:
    assert look_ahead(Gait(sweep=math.radians(10.0))) == pytest.approx(0.5, abs=0.01)
    assert look_ahead(Gait(sweep=math.radians(30.0))) == pytest.approx(0.83, abs=0.01)


@pytest.mark.parametrize(("sweep", "factor"), [(10.0, 4.0), (30.0, 1.8)])
def test_it_beats_the_geometric_controller_at_its_best_gain(sweep: float, factor: float) -> None:
    assert one_eight("gradient", sweep).mean_error * factor <= best_geometric(sweep)


@pytest.mark.parametrize("sweep", [10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0])
def test_it_keeps_the_path_at_every_sweep_of_the_paper(sweep: float) -> None:
    assert one_eight("gradient", sweep).mean_error <= 2.0e-3


def test_a_robot_whose_long_axis_points_at_the_goal_does_not_stand_there_for_ever() -> None:
    one = walker("gradient", 35.0, {}, trajectories.build("eight", {}), Pose(0.0, -0.060, 0.0))
    for index in range(150):
        one.advance(index * 0.1, 0.1)
    assert one.pose.distance_to(*one.reference.point) < 5e-3


def mean_deviation(start_heading: float, **parameters: object) -> float:
    """From the direction of a circle, once the robot has had time to turn, rad."""
    circle = trajectories.build("circle", {"direction": "anticlockwise"})
    one = walker("gradient", 10.0, parameters, circle, Pose(0.0, -0.035, start_heading))
    errors = []
    for index in range(600):
        one.advance(index * 0.1, 0.1)
        x, y = one.reference.point
        errors.append(abs(wrap(one.pose.heading - math.atan2(y, x) - 0.5 * math.pi)))
    return sum(errors[200:]) / 400


def test_a_robot_put_down_the_wrong_way_round_walks_backwards_unless_its_heading_matters() -> None:
    assert mean_deviation(3.0) > math.radians(150.0)
    assert mean_deviation(3.0, heading="along", heading_weight=0.2) < math.radians(15.0)
    assert mean_deviation(0.0, heading="across", heading_weight=0.2) > math.radians(60.0)
