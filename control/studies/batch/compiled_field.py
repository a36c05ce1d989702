"""`FieldModel` and `Bench` for compiled code: the field's motion, and how it leads the robot.

All functions here are plain Python; `control.studies.batch.laws` makes them callable from the kernel.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from control.backlash import ENGAGED_AFTER, LARGEST, lag_after, pull_after
from control.field_model import raised_until, turned_until
from control.model import wrap
from control.simulation.plant import turn_towards
from control.studies.batch.bench import STEP, WHOLE_STEPS
from control.studies.batch.compiled_robot import Body, Robot, at_heading, pulled, watched


class FieldNow(NamedTuple):
    """time: s.  heading, elevation, and where they go: rad.  rate: rad/s."""

    time: float
    heading: float
    elevation: float
    goal: float
    target: float
    rate: float


class Sight(NamedTuple):
    """What `Backlash` has learned: lag by direction (rad) and sightings, and the pull of the field (rad)."""

    pull: float
    lag_left: float
    lag_right: float
    seen_left: int
    seen_right: int


def piece(field: FieldNow, until: float, speed: float) -> FieldNow:
    """The field after one straight piece of its motion, which ends at `until` (s) at the latest.

    speed: of the elevation, rad/s.
    """
    heading, elevation = field.heading, field.elevation
    if elevation != field.target:
        end, elevation = raised_until(field.time, elevation, field.target, speed, until)
    else:
        end, heading = turned_until(field.time, heading, field.goal, field.rate, until)
    later = max(end, np.nextafter(field.time, math.inf))
    return FieldNow(later, heading, elevation, field.goal, field.target, field.rate)


def steps_in(elapsed: float) -> int:
    """How many steps a piece of so many seconds takes."""
    return max(1, math.ceil(elapsed / STEP - WHOLE_STEPS))


def led(body: Body, field: FieldNow, after: FieldNow, robot: Robot) -> Body:
    """The robot led along one piece of the field's motion."""
    if field.elevation == after.elevation:
        return led_round(body, field, after, robot)
    elapsed = after.time - field.time
    count = steps_in(elapsed)
    for number in range(1, count + 1):
        share = number / count
        heading = field.heading + share * (after.heading - field.heading)
        elevation = field.elevation + share * (after.elevation - field.elevation)
        body = pulled(body, heading, elevation, elapsed / count, robot)
    return body


def led_round(body: Body, field: FieldNow, after: FieldNow, robot: Robot) -> Body:
    """The same at a constant elevation, at which no pivot is taken: the place follows from the last heading."""
    hold, heading = body.hold, body.heading
    elapsed, turning = after.time - field.time, after.heading - field.heading
    count = steps_in(elapsed)
    dt = elapsed / count
    for number in range(1, count + 1):
        hold = watched(hold, after.elevation, dt)
        heading += turn_towards(heading, field.heading + number / count * turning, body.play, dt)
    return at_heading(body, heading, hold, robot.length)


def seen(sight: Sight, angle: float, lag: float) -> Sight:
    """The field has turned by `angle` and leads the body by `lag`, rad."""
    pull = pull_after(sight.pull, angle)
    left, right, lefts, rights = sight.lag_left, sight.lag_right, sight.seen_left, sight.seen_right
    if abs(pull) >= ENGAGED_AFTER and abs(lag) <= LARGEST:
        if pull > 0.0:
            lefts += 1
            left = lag_after(left, lefts, lag)
        else:
            rights += 1
            right = lag_after(right, rights, lag)
    return Sight(pull, left, right, lefts, rights)


def advanced(body: Body, field: FieldNow, until: float, robot: Robot, speed: float) -> tuple[Body, FieldNow]:
    """Robot and field at `until`, s."""
    while field.time < until:
        after = piece(field, until, speed)
        body = led(body, field, after, robot)
        field = after
    return body, field


def looked(sight: Sight, before: FieldNow, field: FieldNow, body: Body) -> Sight:
    """One look at a tick's end."""
    return seen(sight, field.heading - before.heading, wrap(field.heading - body.heading))


PARTS = (piece, steps_in, led, led_round, seen, advanced, looked)
