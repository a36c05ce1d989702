"""`SlipPlant` for compiled code: the same formulas over values that are handed on.

All functions here are plain Python; `control.studies.batch.laws` makes them callable from the kernel.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from control.model import PIVOT_A, PIVOT_B, Pivot, pivot_point
from control.simulation.plant import (
    PRESSING_ELEVATION,
    hung_on,
    mean_forward,
    slid,
    turn_towards,
    watch_elevation,
)
from control.simulation.slip import between_rows, mixed

PLAY, PLAY_SD, OUT, OUT_SD, FORWARD_BASE, FORWARD_PER_SWEEP, FORWARD_SD = range(1, 8)
"""Columns of `Robot.rows`, in the order of the fields of `Slip`."""
DRAWS_OF_A_SWITCH = 3


class Robot(NamedTuple):
    """rows: (n, 8) of the slip table.  tilts: (n,) its first column, rad.  draws: standard normal.

    factor: on the table's displacements.  length: between the pivots, m.
    """

    rows: NDArray[np.float64]
    tilts: NDArray[np.float64]
    draws: NDArray[np.float64]
    factor: float
    length: float


class Hold(NamedTuple):
    """What `watch_elevation` keeps: rad, rad, s."""

    settled: float
    held: float
    held_for: float


class Body(NamedTuple):
    """Centre (m), heading (rad), pivot with its place (m), heading when it was taken, play (rad), draws used."""

    x: float
    y: float
    heading: float
    pivot: Pivot
    pivot_x: float
    pivot_y: float
    began: float
    play: float
    drawn: int
    hold: Hold


def taken_up(x: float, y: float, heading: float, tilt: float, robot: Robot) -> Body:
    """The robot out of rest, on pivot A (which a field of the elevation -tilt presses down), m and rad."""
    lying = Body(x, y, heading, PIVOT_A, 0.0, 0.0, heading, 0.0, 0, Hold(tilt, -tilt, 0.0))
    return stood_on(lying, PIVOT_A, drawn_play(robot, tilt, 0), 1, robot)


def stood_on(body: Body, pivot: Pivot, play: float, drawn: int, robot: Robot) -> Body:
    """The robot with another fixed point and play (rad), after so many draws."""
    x, y = pivot_point(body, pivot, robot.length)
    return Body(body.x, body.y, body.heading, pivot, x, y, body.heading, play, drawn, body.hold)


def drawn_play(robot: Robot, tilt: float, draw: int) -> float:
    """The play that the friction here gives, rad."""
    mean, deviation = column_at(robot, tilt, PLAY), column_at(robot, tilt, PLAY_SD)
    return max(0.0, mean + robot.draws[draw] * deviation)


def column_at(robot: Robot, tilt: float, column: int) -> float:
    """One figure of the slip table at `tilt` (rad)."""
    low, share = between_rows(robot.tilts, tilt)
    if share == 0.0:
        return robot.rows[low, column]
    return mixed(robot.rows[low, column], robot.rows[low + 1, column], share)


def displacement(robot: Robot, tilt: float, column: int) -> float:
    """The same for displacements of a robot of this length, m."""
    return robot.factor * column_at(robot, tilt, column)


def switched(body: Body, pivot: Pivot, robot: Robot) -> Body:
    """The robot on its other pivot, slipped."""
    sweep, draw, settled = body.heading - body.began, body.drawn, body.hold.settled
    base = displacement(robot, settled, FORWARD_BASE)
    mean = mean_forward(body.pivot, sweep, base, displacement(robot, settled, FORWARD_PER_SWEEP))
    out = displacement(robot, settled, OUT)
    towards_a = pivot * (out + robot.draws[draw] * displacement(robot, settled, OUT_SD))
    forward = mean + robot.draws[draw + 1] * displacement(robot, settled, FORWARD_SD)
    play = drawn_play(robot, settled, draw + 2)
    x, y = slid(body.x, body.y, body.heading, towards_a, forward)
    there = Body(x, y, body.heading, pivot, 0.0, 0.0, 0.0, play, draw, body.hold)
    return stood_on(there, pivot, play, draw + DRAWS_OF_A_SWITCH, robot)


def at_heading(body: Body, heading: float, hold: Hold, length: float) -> Body:
    """The robot turned about its pivot to another heading (rad); length: m."""
    x, y = body.x, body.y
    if heading != body.heading:
        x, y = hung_on(body.pivot_x, body.pivot_y, heading, 0.5 * length * body.pivot)
    return Body(
        x,
        y,
        heading,
        body.pivot,
        body.pivot_x,
        body.pivot_y,
        body.began,
        body.play,
        body.drawn,
        hold,
    )


def watched(hold: Hold, elevation: float, dt: float) -> Hold:
    """One look at the field's elevation (rad) after `dt` s."""
    settled, held, held_for = watch_elevation(hold.settled, hold.held, hold.held_for, elevation, dt)
    return Hold(settled, held, held_for)


def pulled(body: Body, heading: float, elevation: float, dt: float, robot: Robot) -> Body:
    """The robot after one step in a field of this heading and elevation, rad."""
    if not -PRESSING_ELEVATION < elevation < PRESSING_ELEVATION:
        pressed = PIVOT_B if elevation > 0.0 else PIVOT_A
        if pressed != body.pivot:
            body = switched(body, pressed, robot)
    turn = turn_towards(body.heading, heading, body.play, dt)
    return at_heading(body, body.heading + turn, watched(body.hold, elevation, dt), robot.length)


PARTS = (taken_up, stood_on, drawn_play, column_at, displacement, switched, at_heading, watched, pulled)
