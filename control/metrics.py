"""How well a run followed its reference; the figures the paper and the catalogue use."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from control.gait import Counts
from control.model import Pose, distance


@dataclass(frozen=True, slots=True)
class Metrics:
    """Errors are distances of the robot's centre from the reference, m; ME of the paper is normalized_mean_error."""

    mean_error: float
    normalized_mean_error: float
    rms_error: float
    max_error: float
    end_error: float
    travelled: float
    duration: float
    ticks: int
    steps: int
    sweeps: int
    reversals: int


class Sums(NamedTuple):
    """Over the ticks of a run; errors and the way travelled in m."""

    ticks: int
    errors: float
    squares: float
    largest: float
    last: float
    travelled: float

    def metrics(self, length: float, counts: Counts, duration: float) -> Metrics:
        """length: between the pivots, m.  duration: s."""
        ticks = max(self.ticks, 1)
        mean_error = self.errors / ticks
        return Metrics(
            mean_error=mean_error,
            normalized_mean_error=mean_error / length,
            rms_error=math.sqrt(self.squares / ticks),
            max_error=self.largest,
            end_error=self.last,
            travelled=self.travelled,
            duration=duration,
            ticks=self.ticks,
            steps=counts.steps,
            sweeps=counts.sweeps,
            reversals=counts.reversals,
        )


class MetricsTally:
    """Running sums over the ticks of a run; its size does not grow."""

    def __init__(self, length: float) -> None:
        """length: distance between the pivots, m; the paper divides the mean error by it."""
        self._length = length
        self._sum = self._sum_of_squares = self._largest = self._last = self._travelled = 0.0
        self._ticks = 0
        self._previous: Pose | None = None

    def add(self, pose: Pose, error: float) -> None:
        """One tick: the estimate and its distance from the reference, m."""
        self._ticks += 1
        self._sum += error
        self._sum_of_squares += error * error
        self._largest = max(self._largest, error)
        self._last = error
        if self._previous is not None:
            self._travelled += distance(pose.x, pose.y, self._previous.x, self._previous.y)
        self._previous = pose

    @property
    def mean_error(self) -> float:
        return self._sum / self._ticks if self._ticks else 0.0

    def metrics(self, counts: Counts, duration: float) -> Metrics:
        sums = Sums(self._ticks, self._sum, self._sum_of_squares, self._largest, self._last, self._travelled)
        return sums.metrics(self._length, counts, duration)
