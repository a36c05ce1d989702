"""Time laws: how fast the reference moves along a path.

A path has a clock of its own. A law says where that clock stands after a time of the rig, so that a
controller is handed a path which runs at one second per second of the rig, whatever the law.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

from control.gait import Gait, TimeLaw
from control.trajectories.arc_length import ArcLength
from control.trajectories.trajectory import Path


class Law(Protocol):
    """Times are s of the rig, path times are s of the path's own clock and go on over many passes."""

    @property
    def whole(self) -> float:
        """Time for the whole walk, s."""
        ...

    @property
    def pace(self) -> float:
        """Typical speed along the path, m/s."""
        ...

    @property
    def rests(self) -> bool:
        """The reference comes to rest at the end of the whole walk, even on a closed path."""
        ...

    def path_time(self, time: float) -> float:
        """The path's clock after `time`, s."""
        ...

    def time(self, path_time: float) -> float:
        """When the path's clock stands at `path_time`, s."""
        ...


@dataclass(frozen=True, slots=True)
class PathStep:
    """The paper's law: the path's own clock at a fixed rate. speed: s of path time per s."""

    lengths: ArcLength
    passes: float
    speed: float
    rests: bool = False

    @property
    def whole(self) -> float:
        return self.passes * self.lengths.path.duration / self.speed

    @property
    def pace(self) -> float:
        return self.lengths.whole / self.lengths.path.duration * self.speed

    def path_time(self, time: float) -> float:
        return time * self.speed

    def time(self, path_time: float) -> float:
        return path_time / self.speed


@dataclass(frozen=True, slots=True)
class ConstantSpeed:
    """The same speed all along the path, whatever the path's own clock does. pace: m/s."""

    lengths: ArcLength
    passes: float
    pace: float
    rests: bool = False

    @property
    def whole(self) -> float:
        return self.passes * self.lengths.whole / self.pace

    def path_time(self, time: float) -> float:
        return self.lengths.time_at(time * self.pace)

    def time(self, path_time: float) -> float:
        return self.lengths.length_at(path_time) / self.pace


@dataclass(frozen=True, slots=True)
class Trapezoidal:
    """From rest to rest over `distance` (m): speeds up, keeps its speed, slows down.

    pace: the speed in the middle, m/s; lower where the distance is too short for it.  acceleration: m/s^2.
    """

    lengths: ArcLength
    distance: float
    pace: float
    acceleration: float
    rests: bool = True

    @property
    def whole(self) -> float:
        return self.distance / self._peak + self._ramp

    @property
    def _peak(self) -> float:
        """Highest speed, m/s."""
        return min(self.pace, math.sqrt(self.acceleration * self.distance))

    @property
    def _ramp(self) -> float:
        """Time of speeding up, and of slowing down, s."""
        return self._peak / self.acceleration

    def path_time(self, time: float) -> float:
        left = self.whole - time
        if left <= 0.0:
            return self.lengths.time_at(self.distance)
        if left < self._ramp:
            return self.lengths.time_at(self.distance - 0.5 * self.acceleration * left**2)
        if time < self._ramp:
            return self.lengths.time_at(0.5 * self.acceleration * max(0.0, time) ** 2)
        return self.lengths.time_at(self._peak * (time - 0.5 * self._ramp))

    def time(self, path_time: float) -> float:
        walked = min(self.lengths.length_at(path_time), self.distance)
        left, ramp = self.distance - walked, 0.5 * self._peak * self._ramp
        if walked < ramp:
            return math.sqrt(2.0 * walked / self.acceleration)
        if left < ramp:
            return self.whole - math.sqrt(2.0 * left / self.acceleration)
        return walked / self._peak + 0.5 * self._ramp


def law_of(gait: Gait, lengths: ArcLength, passes: float) -> Law:
    """The law that the gait asks for; except by the paper's, an open path is walked once at most."""
    if gait.time_law is TimeLaw.PATH_STEP:
        return PathStep(lengths, passes, gait.reference_speed)
    walked = passes if lengths.path.closed else min(passes, 1.0)
    if gait.time_law is TimeLaw.TRAPEZOIDAL:
        return Trapezoidal(lengths, walked * lengths.whole, gait.speed, gait.acceleration)
    return ConstantSpeed(lengths, walked, gait.speed)


@dataclass(frozen=True, slots=True)
class Retimed:
    """A path under a time law: its clock is the rig's."""

    path: Path
    law: Law

    @property
    def closed(self) -> bool:
        return self.path.closed and not self.law.rests

    @property
    def duration(self) -> float:
        """Time of one pass, s; of the whole walk where it ends at rest."""
        return self.law.whole if self.law.rests else self.law.time(self.path.duration)

    def point(self, time: float) -> tuple[float, float]:
        return self.path.point(self.law.path_time(time))
