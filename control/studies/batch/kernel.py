"""The compiled walk. Its machine code is kept on the disk, and it runs without the interpreter's lock."""

from __future__ import annotations

import fcntl
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from numba import njit
from numba.core.dispatcher import Dispatcher

from control.studies.batch.compiled_robot import Robot
from control.studies.batch.compiled_walk import Course, Outcome, Start, Task, walked
from control.studies.batch.laws import LAWS

LOCK = "kernel.lock"
"""Beside the kept machine code."""


def _kernel(laws: str) -> Dispatcher:
    def walk(task, start, course, robot, speed):
        # What a kept kernel is known by includes the variables that it closes over, and so the laws.
        _ = laws
        return walked(task, start, course, robot, speed)

    try:
        return njit(cache=True, nogil=True, error_model="numpy")(walk)
    except RuntimeError:  # no folder that may be written to: compile anew in each process
        return njit(nogil=True, error_model="numpy")(walk)


walk_compiled = _kernel(LAWS)


def walk(task: Task, start: Start, course: Course, robot: Robot, speed: float) -> Outcome:
    """One run. Of several processes that begin at once, one compiles, and the others read what it has kept."""
    if walk_compiled.signatures:
        return walk_compiled(task, start, course, robot, speed)
    with alone_in(walk_compiled.stats.cache_path):
        return walk_compiled(task, start, course, robot, speed)


@contextmanager
def alone_in(folder: str | None) -> Iterator[None]:
    """No other process is here meanwhile; nobody waits where nothing is kept, or nothing can be locked."""
    with ExitStack() as stack:
        if folder is not None:
            with suppress(OSError):
                lock = stack.enter_context((Path(folder) / LOCK).open("ab"))
                fcntl.flock(lock, fcntl.LOCK_EX)
        yield
