"""Which runs the kernel can walk, and a walk by it."""

from __future__ import annotations

import math
import random
from dataclasses import astuple, dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from control.controllers import Controller
from control.controllers.geometric import Geometric
from control.controllers.gradient import Gradient
from control.gait import Counts, Gait, TimeLaw, advance_of_sweep
from control.metrics import Metrics
from control.simulation.plant import PRESSING_ELEVATION, REST_FIELD
from control.simulation.plants import NoSlipKind, SlipKind
from control.simulation.slip import SlipParameters
from control.studies.batch.bench import OVERSHOOT
from control.studies.batch.compiled_robot import DRAWS_OF_A_SWITCH, Robot
from control.studies.batch.compiled_walk import GEOMETRIC, GRADIENT, LEFT, UNDRAWN, Course, Start, Task
from control.studies.batch.courses import Courses, LaidOut, Wanted
from control.studies.batch.plain import require_inside, start_of

if TYPE_CHECKING:
    from control.studies.plan import PlannedRun

SPARE = 1.3
"""Switches that random numbers are drawn for at first, per switch of a robot that keeps to its path."""

_courses = Courses()


@dataclass(frozen=True, slots=True)
class Prepared:
    """A run that the kernel can walk."""

    run: PlannedRun
    task: Task
    course: LaidOut
    table: SlipParameters


def prepared(run: PlannedRun) -> Prepared | None:
    """The run for the kernel; None for one that only the plain loop can walk."""
    table, gait = _table(run), run.selection.gait
    if table is None or not _is_plain_gait(gait):
        return None
    task = _task(run, run.selection.build_controller())
    if task is None:
        return None
    look_ahead = task.look_ahead if task.law == GRADIENT else None
    course = _courses.get(Wanted(run.selection, run.passes, run.duration, look_ahead))
    return None if course is None else Prepared(run, task, course, table)


def walk_prepared(prepared: Prepared) -> Metrics:
    """The figures of the run, as `plain_walk` finds them; raises `RunFailed` like it."""
    from control.studies.batch.kernel import walk

    run, task, course = prepared.run, prepared.task, prepared.course
    start, setup = start_of(run), run.setup
    speed = 2.0 * task.tilt / setup.ramp
    # Compiled code is made for certain types: a whole number would ask for another kernel.
    begun = Start(float(start.x), float(start.y), float(start.heading))
    draw, draws, more = random.Random(run.seed).gauss, list[float](), _first_draws(course, task)
    while True:
        draws += [draw(0.0, 1.0) for _ in range(max(more, len(draws)))]
        robot = _robot(prepared.table, draws, setup.length)
        outcome = walk(task, begun, Course(course.points, course.ahead), robot, speed)
        if outcome.end != UNDRAWN:
            break
    if outcome.end == LEFT:
        require_inside(outcome.x, outcome.y, outcome.tick, setup.workspace)
    tally = outcome.tally
    counts = Counts(tally.steps, tally.sweeps, tally.reversals)
    return outcome.sums.metrics(setup.length, counts, course.duration)


def _first_draws(course: LaidOut, task: Task) -> int:
    """As many as the run will probably use; twice as many are drawn where they do not suffice."""
    switches = SPARE * course.length / advance_of_sweep(min(task.sweep, math.pi), task.length)
    switches = min(switches, len(course.points))  # a tick has one at most
    return 2 * DRAWS_OF_A_SWITCH + math.ceil(DRAWS_OF_A_SWITCH * switches)


def _table(run: PlannedRun) -> SlipParameters | None:
    kind = run.plant.kind()
    return kind.table if isinstance(kind, SlipKind | NoSlipKind) else None


def _is_plain_gait(gait: Gait) -> bool:
    """The reference waits for nobody, and the field holds the robot and presses its ends down."""
    holds = gait.field * np.cos(gait.tilt) >= 2.0 * REST_FIELD and gait.tilt >= 2.0 * PRESSING_ELEVATION
    return bool(holds) and not gait.approach and gait.time_law is not TimeLaw.WAIT


def _task(run: PlannedRun, controller: Controller) -> Task | None:
    gait, setup = run.selection.gait, run.setup
    if type(controller) is Geometric:
        law, gain, look_ahead = GEOMETRIC, controller.gain, 0.0
    elif type(controller) is Gradient and not controller.regulates_heading:
        law, gain, look_ahead = GRADIENT, 0.0, controller.look_ahead(gait)
    else:
        return None
    values = gain, look_ahead, gait.sweep, gait.tilt, gait.max_rate, setup.length, setup.workspace + OVERSHOOT
    return Task(law, *(float(value) for value in values))


def _robot(table: SlipParameters, draws: list[float], length: float) -> Robot:
    rows = _rows(table)
    return Robot(
        rows,
        np.ascontiguousarray(rows[:, 0]),
        np.array(draws),
        float(length / table.reference_length),
        float(length),
    )


@lru_cache(maxsize=64)
def _rows(table: SlipParameters) -> NDArray[np.float64]:
    return np.array([astuple(row) for row in table.rows])
