"""`Walk` and `Walker` for compiled code: from the law's decision to the field's goal, and the figures of a run.

All functions here are plain Python; `control.studies.batch.laws` makes them callable from the kernel.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from control.controllers.geometric import nearest_pivot, swing_rate
from control.controllers.gradient import Cost, gone_on, is_at_rest_too_far, is_other_lower, lowest_on
from control.gait import remaining_turn, sweep_end
from control.metrics import Sums
from control.model import PIVOT_A, Pivot, distance, opposite
from control.studies.batch.bench import REST, TICK
from control.studies.batch.compiled_field import FieldNow, Sight, advanced, looked
from control.studies.batch.compiled_robot import DRAWS_OF_A_SWITCH, Body, Robot, taken_up
from control.walker import COMPLETE_WITHIN, SETTLE, STUCK_AFTER

GEOMETRIC, GRADIENT = 0, 1
WALKED, LEFT, UNDRAWN = 0, 1, 2
"""How a walk ends: at its end, over the edge, or for want of more random numbers."""


class Task(NamedTuple):
    """law: which controller.  gain: of the geometric one, 1/(m s).  look_ahead: of the gradient's, s.

    sweep, tilt: rad.  max_rate: rad/s.  length, edge: m.
    """

    law: int
    gain: float
    look_ahead: float
    sweep: float
    tilt: float
    max_rate: float
    length: float
    edge: float


class Course(NamedTuple):
    """The desired point at each tick, and what the look-ahead makes of it; (n, 2) each, m."""

    points: NDArray[np.float64]
    ahead: NDArray[np.float64]


class Start(NamedTuple):
    x: float
    y: float
    heading: float


class Stance(NamedTuple):
    """start: heading at which the sweep began, rad.  direction: of turning, a sign."""

    start: float
    pivot: Pivot
    may_switch: bool
    direction: float


class Patience(NamedTuple):
    """With a body that stays behind: how far the field goes on for it (rad), how often, standing still since (s)."""

    extension: float
    extensions: int
    settled_since: float


class Tally(NamedTuple):
    """turning: the sign of the last rate.  The rest as in `Counts`."""

    turning: int
    steps: int
    sweeps: int
    reversals: int


class Outcome(NamedTuple):
    """end: how it ended, at which tick and where (m), with the sums and counts by then."""

    end: int
    tick: int
    x: float
    y: float
    sums: Sums
    tally: Tally


def arrived(
    stance: Stance, patience: Patience, body: Body, field: FieldNow, task: Task
) -> tuple[bool, Patience]:
    """Whether the sweep is complete, as `Walker` says."""
    missing = remaining_turn(task.sweep, body.heading - stance.start, stance.direction)
    if missing <= COMPLETE_WITHIN:
        return True, patience
    if field.elevation != field.target or field.heading != field.goal:
        return False, Patience(patience.extension, patience.extensions, math.inf)
    since = min(patience.settled_since, field.time)
    if field.time - since < SETTLE:
        return False, Patience(patience.extension, patience.extensions, since)
    extensions = patience.extensions + 1
    return extensions > STUCK_AFTER, Patience(patience.extension + missing, extensions, math.inf)


def decided(task: Task, body: Body, stance: Stance, course: Course, tick: int) -> tuple[Pivot, float]:
    """The law's pivot and rate, rad/s."""
    if task.law == GRADIENT:
        ahead = course.ahead[tick, 0], course.ahead[tick, 1]
        return decided_by_gradient(task, body, stance, ahead)
    desired = course.points[tick, 0], course.points[tick, 1]
    pivot = stance.pivot
    if stance.may_switch:
        pivot = nearest_pivot(body, desired, pivot, task.length)
    return pivot, swing_rate(task.gain, pivot, body, desired)


def decided_by_gradient(
    task: Task, body: Body, stance: Stance, ahead: tuple[float, float]
) -> tuple[Pivot, float]:
    """As `Gradient` without a wanted heading. ahead: the desired point after the look-ahead, m."""
    half, tau, pivot = 0.5 * task.length, task.look_ahead, stance.pivot
    cost = Cost(body.x, body.y, body.heading, half, tau, ahead[0], ahead[1], 0.0, 0.0)
    lowest, rate = lowest_on(cost, pivot, task.max_rate)
    if stance.may_switch:
        end, other_rate = lowest_on(cost, opposite(pivot), task.max_rate)
        if is_other_lower(end, lowest, pivot):
            pivot, lowest, rate = opposite(pivot), end, other_rate
    if is_at_rest_too_far(cost, lowest, rate, task.sweep):
        rate = gone_on(rate, body.heading - stance.start, task.sweep, tau, task.max_rate)
    return pivot, rate


def stood(stance: Stance, pivot: Pivot, rate: float) -> Stance:
    """The stance for the law's pivot and the rate that is granted, rad/s."""
    direction = math.copysign(1.0, rate) if rate else stance.direction
    if not stance.may_switch:
        return Stance(stance.start, stance.pivot, False, direction)
    return Stance(stance.start, pivot, rate == 0.0, direction)


def counted(tally: Tally, steps: int, sweeps: int, rate: float) -> Tally:
    """The counts after one tick with so many steps and sweeps, turning at `rate`."""
    turning = (1 if rate > 0.0 else 0) - (1 if rate < 0.0 else 0)
    turned_back = 1 if turning != 0 and turning == -tally.turning else 0
    return Tally(
        turning if turning else tally.turning,
        tally.steps + steps,
        tally.sweeps + sweeps,
        tally.reversals + turned_back,
    )


def told(field: FieldNow, stance: Stance, patience: Patience, lag: float, task: Task) -> FieldNow:
    """The field with the goals of this tick. lag: what it leads by in the stance's direction, rad."""
    lead = lag + stance.direction * patience.extension
    goal = sweep_end(stance.start, task.sweep, stance.direction) + lead
    return FieldNow(field.time, field.heading, field.elevation, goal, -stance.pivot * task.tilt, field.rate)


def turning_at(field: FieldNow, rate: float) -> FieldNow:
    """The field at another rate, rad/s."""
    return FieldNow(field.time, field.heading, field.elevation, field.goal, field.target, rate)


def added(sums: Sums, error: float, travelled: float) -> Sums:
    """One tick more: its error and the way travelled since the last, m."""
    return Sums(
        sums.ticks + 1,
        sums.errors + error,
        sums.squares + error * error,
        max(sums.largest, error),
        error,
        sums.travelled + travelled,
    )


def walked(task: Task, start: Start, course: Course, robot: Robot, speed: float) -> Outcome:
    """One run, tick by tick. speed: of the elevation at a change of pivot, rad/s."""
    body = taken_up(start.x, start.y, start.heading, task.tilt, robot)
    field = FieldNow(0.0, start.heading, -task.tilt, start.heading, -task.tilt, 0.0)
    body, field = advanced(body, field, REST, robot, speed)
    sight = Sight(0.0, 0.0, 0.0, 0, 0)
    stance, patience = Stance(start.heading, PIVOT_A, True, 1.0), Patience(0.0, 0, math.inf)
    sums, tally = Sums(0, 0.0, 0.0, 0.0, 0.0, 0.0), Tally(0, 0, 0, 0)
    last_x, last_y = body.x, body.y
    for tick in range(len(course.points)):
        if tick > 0:
            if len(robot.draws) - body.drawn < DRAWS_OF_A_SWITCH:
                return Outcome(UNDRAWN, tick, body.x, body.y, sums, tally)
            before = field
            body, field = advanced(body, field, REST + tick * TICK, robot, speed)
            sight = looked(sight, before, field, body)
            if not (abs(body.x) <= task.edge and abs(body.y) <= task.edge):
                return Outcome(LEFT, tick, body.x, body.y, sums, tally)
        error = distance(body.x, body.y, course.points[tick, 0], course.points[tick, 1])
        sums = added(sums, error, distance(body.x, body.y, last_x, last_y))
        last_x, last_y = body.x, body.y
        sweeps = 0
        if not stance.may_switch:
            is_complete, patience = arrived(stance, patience, body, field, task)
            if is_complete:
                stance = Stance(body.heading, stance.pivot, True, stance.direction)
                patience, sweeps = Patience(0.0, 0, math.inf), 1
        pivot, wanted = decided(task, body, stance, course, tick)
        rate = max(-task.max_rate, min(task.max_rate, wanted))
        chosen = stood(stance, pivot, rate)
        tally = counted(tally, 1 if chosen.pivot != stance.pivot else 0, sweeps, rate)
        stance = chosen
        lag = sight.lag_left if stance.direction > 0.0 else sight.lag_right
        field = turning_at(told(field, stance, patience, lag, task), rate)
    return Outcome(WALKED, len(course.points) - 1, body.x, body.y, sums, tally)


PARTS = (
    arrived,
    decided,
    decided_by_gradient,
    stood,
    counted,
    told,
    turning_at,
    added,
    walked,
)
