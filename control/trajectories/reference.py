"""The moving reference of one walk: the desired point, and when it waits for the robot."""

from __future__ import annotations

import math

from control.gait import Gait, TimeLaw
from control.model import Pose
from control.trajectories.approach import Approach
from control.trajectories.arc_length import ArcLength
from control.trajectories.time_law import Retimed, law_of
from control.trajectories.trajectory import Path

OFF_PATH = 0.010
"""A robot farther from the path than its own length does not follow it, m."""
COARSE, FINE = 16, 8
"""Points looked at, first along the stretch that is searched and then around the nearest of them: a 32nd of
the distance that the reference may be ahead."""


class Reference:
    """`trajectory` is the path with the rig's clock, and `time` (s) is where the reference is on it."""

    def __init__(
        self, path: Path, gait: Gait, passes: float = 1.0, start: tuple[float, float] | None = None
    ) -> None:
        """passes: of the path, for the whole walk.  start: where the robot stands, m; None for no approach."""
        self._lengths = ArcLength(path)
        self._passes = passes
        self._waited = self._elapsed = 0.0
        self._begin(gait, start)

    def _begin(self, gait: Gait, start: tuple[float, float] | None) -> None:
        self.gait = gait
        self._law = law_of(gait, self._lengths, self._passes)
        course = Retimed(self._lengths.path, self._law)
        self.trajectory = course if start is None else Approach(start, course, self._law.pace)
        self._lead = self.trajectory.lead if isinstance(self.trajectory, Approach) else 0.0
        self.time = 0.0

    @property
    def point(self) -> tuple[float, float]:
        """The desired point now, m."""
        return self.trajectory.point(self.time)

    @property
    def is_approaching(self) -> bool:
        """The path has not begun yet."""
        return self.time < self._lead

    @property
    def path_time(self) -> float:
        """The path's own clock now, s."""
        return 0.0 if self.is_approaching else self._law.path_time(self.time - self._lead)

    @property
    def passes_done(self) -> float:
        return self.path_time / self._lengths.path.duration

    @property
    def is_over(self) -> bool:
        return self.time >= self._lead + self._law.whole

    @property
    def duration(self) -> float:
        """How long the whole walk takes, s, when the reference waits no more than it has so far."""
        return self._waited + self._lead + self._law.whole

    def advance_to(self, elapsed: float, pose: Pose) -> None:
        """Move on to `elapsed` seconds since the walk began, with the robot at `pose`; never goes back."""
        self._elapsed = elapsed
        wanted = elapsed - self._waited
        if self.gait.time_law is not TimeLaw.WAIT:
            self.time = wanted
            return
        self.time = max(self.time, min(wanted, self._farthest(pose)))
        self._waited = elapsed - self.time

    def change(self, gait: Gait) -> None:
        """Go on from the same point of the path, or of the approach, by another gait."""
        if gait == self.gait:
            return
        here = self.point if self.is_approaching and gait.approach else None
        path_time = self.path_time
        self._begin(gait, here)
        self.time = 0.0 if here else self._law.time(path_time)
        self._waited = self._elapsed - self.time

    def _farthest(self, pose: Pose) -> float:
        """How far the clock may go for the reference to stay within the waiting distance of the robot, s.

        The robot is where the course is nearest to it, not far behind the reference; nowhere when it is off
        the path.
        """
        ahead = self.gait.wait_distance / self.gait.speed
        robot_at = _nearest(self.trajectory, max(0.0, self.time - 2.0 * ahead), self.time, pose)
        if not pose.distance_to(*self.trajectory.point(robot_at)) <= OFF_PATH:
            return self.time
        return robot_at + ahead


def _nearest(course: Path, first: float, last: float, pose: Pose) -> float:
    """The time (s) in [first, last] at which the course is nearest to the pose; the earliest of several."""

    def distance(time: float) -> float:
        x, y = course.point(time)
        return math.hypot(pose.x - x, pose.y - y)

    step = (last - first) / COARSE
    coarse = min((first + step * k for k in range(COARSE + 1)), key=distance)
    low, high = max(first, coarse - step), min(last, coarse + step)
    return min((low + (high - low) * k / FINE for k in range(FINE + 1)), key=distance)
