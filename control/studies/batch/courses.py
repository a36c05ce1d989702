"""The desired points of a run at all its ticks: the same for all runs that differ in robot and controller only."""

from __future__ import annotations

import json
import threading
from collections import OrderedDict
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from control.gait import Gait
from control.model import Pose
from control.runs import Selection
from control.studies.batch.bench import TICK
from control.trajectories.reference import Reference

NOWHERE = Pose(0.0, 0.0, 0.0)
"""A reference that never waits does not look at the robot."""
MOST_TICKS = 1_000_000
"""Ticks of all courses that are kept, and of the longest that is laid out at all (4.6 h): 32 MB."""


@dataclass(frozen=True, slots=True)
class LaidOut:
    """points: (n, 2), the desired points, m.  ahead: the same after the look-ahead.  duration: of the run, s.

    length: of the way from the first point to the last, m.
    """

    points: NDArray[np.float64]
    ahead: NDArray[np.float64]
    duration: float
    length: float


@dataclass(frozen=True, slots=True)
class Wanted:
    """What a course depends on. duration: a cap, s, or None.  look_ahead: s, or None where nobody looks ahead."""

    selection: Selection
    passes: float
    duration: float | None
    look_ahead: float | None

    @property
    def key(self) -> tuple[object, ...]:
        gait, trajectory = self.selection.gait, self.selection.trajectory
        return (
            trajectory.name,
            json.dumps(dict(trajectory.parameters), sort_keys=True, default=str),
            self.passes,
            self.duration,
            self.look_ahead,
            _pace(gait),
        )


def _pace(gait: Gait) -> tuple[object, ...]:
    return gait.time_law, gait.path_step, gait.speed, gait.acceleration


class Courses:
    """Keeps the courses that were used last; for any number of threads, as a cluster's workers have them."""

    def __init__(self, most_ticks: int = MOST_TICKS) -> None:
        self._most_ticks = most_ticks
        self._kept: OrderedDict[tuple[object, ...], LaidOut] = OrderedDict()
        self._lock = threading.Lock()

    @property
    def ticks(self) -> int:
        """Of all courses that are kept."""
        return sum(len(kept.points) for kept in self._kept.values())

    def get(self, wanted: Wanted) -> LaidOut | None:
        """None for a course that is too long, or leads to what is no place."""
        with self._lock:
            course = self._kept.get(wanted.key) or lay_out(wanted)
            if course is not None:
                self._keep(wanted.key, course)
            return course

    def _keep(self, key: tuple[object, ...], course: LaidOut) -> None:
        self._kept[key] = course
        self._kept.move_to_end(key)
        while self.ticks > self._most_ticks:
            self._kept.popitem(last=False)


def lay_out(wanted: Wanted) -> LaidOut | None:
    """The course tick by tick, as a walk on the rig has it."""
    selection = wanted.selection
    reference = Reference(selection.build_trajectory(), selection.gait, wanted.passes)
    if not min(reference.duration, wanted.duration or np.inf) <= MOST_TICKS * TICK:
        return None
    ahead = wanted.look_ahead
    rows, times = list[tuple[float, ...]](), list[float]()
    for elapsed in _ticks(reference, wanted.duration):
        times.append(elapsed)
        point = reference.point
        rows.append(point if ahead is None else (*point, *reference.trajectory.point(reference.time + ahead)))
    course = np.array(rows)
    if not np.isfinite(course).all():
        return None
    points = np.ascontiguousarray(course[:, :2])
    length = float(np.hypot(*np.diff(points, axis=0).T).sum())
    return LaidOut(
        points, points if ahead is None else np.ascontiguousarray(course[:, 2:]), times[-1], length
    )


def _ticks(reference: Reference, cap: float | None) -> Iterator[float]:
    """The time since the run began at each of its ticks, s, with the reference moved on to it."""
    elapsed = 0.0
    while True:
        elapsed += TICK
        reference.advance_to(elapsed, NOWHERE)
        yield elapsed
        if reference.is_over or (cap is not None and elapsed >= cap):
            return
