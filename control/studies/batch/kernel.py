"""The compiled walk. Its machine code is kept on the disk, and it runs without the interpreter's lock."""

from __future__ import annotations

from collections.abc import Callable

from numba import njit

from control.studies.batch.compiled_robot import Robot
from control.studies.batch.compiled_walk import Course, Outcome, Start, Task, walked
from control.studies.batch.laws import LAWS

Kernel = Callable[[Task, Start, Course, Robot, float], Outcome]


def _kernel(laws: str) -> Kernel:
    def walk(task, start, course, robot, speed):
        # What a kept kernel is known by includes the variables that it closes over, and so the laws.
        _ = laws
        return walked(task, start, course, robot, speed)

    try:
        return njit(cache=True, nogil=True, error_model="numpy")(walk)
    except RuntimeError:  # no folder that may be written to: compile anew in each process
        return njit(nogil=True, error_model="numpy")(walk)


walk_compiled: Kernel = _kernel(LAWS)
