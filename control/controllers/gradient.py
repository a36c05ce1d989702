"""The optimization controller, "Ob" (paper, section 4), made exact.

J(omega, sigma) = 1/2 |c(tau) - c_d|^2 + 1/2 w L^2 (theta(tau) - theta_d)^2, where c(tau) and theta(tau) are the
centre and heading after turning at the rate omega about the pivot sigma for the look-ahead tau, by the exact arc,
and c_d is where the reference will be then. Differs from print: descent instead of ascent, the missing L/2, a
weight that makes the heading term commensurable, and a look-ahead longer than one tick, because a gradient over
one tick cannot see past the sweep that it is committed to. The pivot has two values only, so the descent is made
on either and the lower end taken, where print relaxes sigma, descends and rounds by its sign.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from pydantic import Field

from control.controllers.controller import Decision, Situation, controllers
from control.controllers.heading import HeadingParameters, WantedHeading
from control.gait import Gait
from control.model import Pivot, distance, opposite, wrap

BASE_LOOK_AHEAD = 0.33
LOOK_AHEAD_PER_SWEEP = 0.955
"""Look-ahead of 0.5 s at a sweep of 10 degrees and 0.83 s at 30, s and s/rad: best in pure kinematics."""
ITERATIONS = 12
CONVERGED = 1e-4
"""The descent ends when a step is smaller than this, rad/s."""
LARGEST_TURN = 0.5
"""Largest change of the turn over the look-ahead in one step of the descent, rad."""
TINY = 1e-12
"""Keeps the curvature away from zero where the desired point lies on the pivot, m^2."""
FIRST_TURN = 0.2
"""The two directions of turning are tried from this far on either side of standing still, rad."""
ALIKE = 1e-12
"""Ends of the descent whose J differ by less are equally low, m^2: a nanometre at a millimetre from the desired point.

More than `CONVERGED` leaves (1e-13) and far more than rounding does, so that what lies symmetrically, as two pivots
side by side before a point straight ahead, is not told apart by the last digit of a sine.
"""
SHORT_OF_GOAL = 0.3
"""A robot that comes to rest farther than this from the desired point, in lengths, has to use the other pivot."""


class GradientParameters(HeadingParameters):
    look_ahead_s: float | None = Field(
        default=None, gt=0.0, le=5.0, title="Look-ahead",
        description="How far ahead the arc is predicted; left out, it follows from the sweep.",
        json_schema_extra={"unit": "s", "live": True, "step": 0.1},
    )  # fmt: skip


class Cost(NamedTuple):
    """The value of J and its derivatives, for one situation.

    x, y, heading: the robot's.  half: L/2.  look_ahead: tau, s.  desired_x, desired_y: where to be then, m.
    wanted, weight: heading to have then, rad, and w L^2, m^2.
    """

    x: float
    y: float
    heading: float
    half: float
    look_ahead: float
    desired_x: float
    desired_y: float
    wanted: float
    weight: float


def cost_value(cost: Cost, rate: float, sigma: float) -> float:
    """J, m^2."""
    error_x, error_y, error_heading, _, _ = cost_errors(cost, rate, sigma)
    return 0.5 * (error_x * error_x + error_y * error_y + cost.weight * (error_heading * error_heading))


def cost_by_rate(cost: Cost, rate: float, sigma: float) -> float:
    """dJ/d omega, m^2 s: dc/d omega = (L/2) sigma tau [cos theta', sin theta']."""
    error_x, error_y, error_heading, sine, cosine = cost_errors(cost, rate, sigma)
    along = cost.half * sigma * (error_x * cosine + error_y * sine)
    return cost.look_ahead * (along + cost.weight * error_heading)


def cost_errors(cost: Cost, rate: float, sigma: float) -> tuple[float, float, float, float, float]:
    """Errors of place (m, m) and heading (rad) after the look-ahead, and sine and cosine of the heading then."""
    after = cost.heading + rate * cost.look_ahead
    sine, cosine = math.sin(after), math.cos(after)
    half = cost.half * sigma
    return (
        cost.x + half * (sine - math.sin(cost.heading)) - cost.desired_x,
        cost.y - half * (cosine - math.cos(cost.heading)) - cost.desired_y,
        wrap(after - cost.wanted) if cost.weight else 0.0,
        sine,
        cosine,
    )


def distance_from_pivot(cost: Cost, sigma: float) -> float:
    """Of the desired point, m."""
    half = cost.half * sigma
    x, y = cost.x - half * math.sin(cost.heading), cost.y + half * math.cos(cost.heading)
    return distance(x, y, cost.desired_x, cost.desired_y)


def descend(cost: Cost, sigma: float, rate: float, max_rate: float) -> float:
    """Follow -dJ/d omega from `rate` to rest, within the limits; rad/s.

    With D the desired point's distance from the pivot, J = 1/2 ((L/2)^2 + D^2 - L D cos phi) along the arc, so its
    curvature is at most ((L/2) D + w L^2) tau^2, and is that at the minimum: a step of the gradient over this
    never climbs and converges like Newton's.
    """
    tau = cost.look_ahead
    scale = 1.0 / ((cost.half * distance_from_pivot(cost, sigma) + cost.weight + TINY) * tau * tau)
    largest = LARGEST_TURN / tau
    for _ in range(ITERATIONS):
        step = max(-largest, min(largest, scale * cost_by_rate(cost, rate, sigma)))
        before = rate
        rate = max(-max_rate, min(max_rate, rate - step))
        if abs(rate - before) < CONVERGED:
            break
    return rate


def lowest_on(cost: Cost, sigma: float, max_rate: float) -> tuple[float, float]:
    """The lowest J (m^2) about one pivot, from a start on each way round, and its rate (rad/s).

    Of ends that are alike, that of the start to the right, by the smaller rate.
    """
    first = FIRST_TURN / cost.look_ahead
    rate, other = descend(cost, sigma, first, max_rate), descend(cost, sigma, -first, max_rate)
    value, other_value = cost_value(cost, rate, sigma), cost_value(cost, other, sigma)
    if other_value < value + ALIKE:
        return other_value, other
    return value, rate


def is_other_lower(end: float, lowest: float, pivot: Pivot) -> bool:
    """Whether the end on the other pivot is lower than that on `pivot`, J in m^2; of ends that are alike, B's is."""
    if abs(end - lowest) < ALIKE:
        return opposite(pivot) < pivot
    return end < lowest


def gone_on(rate: float, turned: float, sweep: float, tau: float, max_rate: float) -> float:
    """Complete the sweep over the look-ahead, the way it has begun: only then may the other pivot be taken."""
    return math.copysign(min(sweep / tau, max_rate), turned or rate)


def is_at_rest_too_far(cost: Cost, lowest: float, rate: float, sweep: float) -> bool:
    """No turn about this pivot comes nearer, yet the robot is not there: the long axis points at the goal."""
    short = SHORT_OF_GOAL * (2.0 * cost.half)
    return lowest > 0.5 * (short * short) and abs(rate * cost.look_ahead) < sweep


@controllers.register
class Gradient:
    """Descends the cost from a start on each pivot and each way round, and takes the lowest end."""

    name = "gradient"
    title = "Optimization (gradient)"
    summary = "Descends the predicted distance to the reference over pivot and rate; can regulate heading."
    Parameters = GradientParameters

    def __init__(self, parameters: GradientParameters) -> None:
        self._look_ahead = parameters.look_ahead_s
        self._weight = parameters.effective_heading_weight
        self._wanted = WantedHeading(parameters)

    @property
    def regulates_heading(self) -> bool:
        return bool(self._weight)

    def look_ahead(self, gait: Gait) -> float:
        """tau, s."""
        return look_ahead(gait) if self._look_ahead is None else self._look_ahead

    def step(self, situation: Situation) -> Decision:
        """sigma may change only when a sweep is complete."""
        cost, gait, pivot = self._cost(situation), situation.gait, situation.pivot
        lowest, rate = lowest_on(cost, pivot, gait.max_rate)
        if situation.may_switch:
            end = lowest_on(cost, opposite(pivot), gait.max_rate)
            if is_other_lower(end[0], lowest, pivot):
                pivot, (lowest, rate) = opposite(pivot), end
        if is_at_rest_too_far(cost, lowest, rate, gait.sweep):
            rate = gone_on(rate, situation.turned, gait.sweep, cost.look_ahead, gait.max_rate)
        return Decision(pivot, rate)

    def _cost(self, situation: Situation) -> Cost:
        tau = self.look_ahead(situation.gait)
        pose = situation.pose
        x, y = situation.desired(tau)
        return Cost(
            pose.x,
            pose.y,
            pose.heading,
            half=0.5 * situation.length,
            look_ahead=tau,
            desired_x=x,
            desired_y=y,
            wanted=self._wanted.at(situation, tau) if self._weight else 0.0,
            weight=self._weight * situation.length**2,
        )


def look_ahead(gait: Gait) -> float:
    """The default look-ahead for a sweep, s."""
    return BASE_LOOK_AHEAD + LOOK_AHEAD_PER_SWEEP * gait.sweep
