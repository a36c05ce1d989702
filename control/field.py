"""Where the board's field points, and where it has pointed a short while ago: what the estimator asks.

The motion is piecewise linear, so its corner points say it all. `FieldModel` keeps them while the rig walks,
`RecordedField` has them from a recording.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass

from control.model import PIVOT_A, PIVOT_B, Pivot

HISTORY = 240
"""Corner points kept: more than a second of walking at 60 drives a second."""


@dataclass(frozen=True, slots=True)
class Corner:
    """The field at `time` (s): heading (unwrapped, rad) and elevation (rad, 0 while it is off)."""

    time: float
    heading: float
    elevation: float

    @property
    def pivot(self) -> Pivot:
        """The end that the field presses down."""
        return PIVOT_B if self.elevation > 0.0 else PIVOT_A


@dataclass(frozen=True, slots=True)
class Turn:
    """One straight piece of motion: the field turned by `angle` (rad) while it pressed on `pivot`."""

    angle: float
    pivot: Pivot


@dataclass(frozen=True, slots=True)
class FieldTrace:
    """What the mirror says at one tick, such that who keeps all traces knows the field at every instant.

    heading (unwrapped), elevation: rad.  strength: T, and full_at: when it is or was complete, s (inf while off).
    corners: the new ones since the last trace, oldest first; all of them when `anew`: those told before do not hold.
    """

    is_on: bool
    heading: float
    elevation: float
    strength: float
    full_at: float
    corners: tuple[Corner, ...]
    anew: bool


class Field:
    """Heading and elevation of the field as they are believed to be, now and in the last seconds."""

    def __init__(self, ramp: float, field_slew: float) -> None:
        """ramp: a full change of pivot, s.  field_slew: how fast the field comes up at arming, T/s."""
        self._ramp = ramp
        self._field_slew = field_slew
        self._on = False
        self._time = -math.inf
        self._heading = 0.0
        self._elevation = 0.0
        self._target_elevation = 0.0
        self._goal = 0.0
        self._strength = 0.0
        self._full_at = math.inf
        self._corners: deque[Corner] = deque(maxlen=HISTORY)

    @property
    def ramp(self) -> float:
        """How long a full change of pivot takes, s; the heading is held meanwhile."""
        return self._ramp

    @property
    def heading(self) -> float:
        return self._heading

    @property
    def elevation(self) -> float:
        return self._elevation

    @property
    def pivot(self) -> Pivot:
        """The end that the field presses down."""
        return PIVOT_B if self._elevation > 0.0 else PIVOT_A

    @property
    def is_on(self) -> bool:
        """Whether the board has been told to drive."""
        return self._on

    @property
    def is_settled(self) -> bool:
        """Full strength, elevation on its target and the heading on its goal: the field stands still."""
        return self.is_ready and self._elevation == self._target_elevation and self._heading == self._goal

    @property
    def is_ready(self) -> bool:
        """On, and at full strength."""
        return self._on and self._time >= self._full_at

    @property
    def full_at(self) -> float:
        """When the field reaches or reached full strength since it was last off, s; inf while it is off."""
        return self._full_at if self._on else math.inf

    def heading_at(self, time: float) -> float:
        """The field's heading at a recent `time`, rad, unwrapped."""
        earlier, later, share = self._about(time)
        return earlier.heading + share * (later.heading - earlier.heading)

    def elevation_at(self, time: float) -> float:
        """The field's elevation at a recent `time`, rad: positive presses on B; 0 while it was off."""
        earlier, later, share = self._about(time)
        return earlier.elevation + share * (later.elevation - earlier.elevation)

    def pivot_at(self, time: float) -> Pivot:
        """The end that the field pressed down at a recent `time`."""
        return PIVOT_B if self.elevation_at(time) > 0.0 else PIVOT_A

    def strength_at(self, time: float) -> float:
        """How strong the field was at a recent `time`, T, as it comes up from zero after the arm edge."""
        if not self._on:
            return 0.0
        return max(0.0, min(self._strength, self._strength - (self._full_at - time) * self._field_slew))

    def _about(self, time: float) -> tuple[Corner, Corner, float]:
        """The corners before and after a recent `time`, and the share of the way between them that lies behind."""
        later: Corner | None = None
        for corner in reversed(self._corners):
            if corner.time <= time:
                if later is None:
                    return corner, corner, 0.0
                return corner, later, (time - corner.time) / (later.time - corner.time)
            later = corner
        only = later or Corner(time, self._heading, self._elevation)
        return only, only, 0.0

    def turns(self, start: float, end: float) -> list[Turn]:
        """The pieces of motion between two recent instants (s), oldest first.

        A piece that `end` cuts presses on the end that it presses on by then: the ramp through zero is one piece.
        """
        inner: list[Corner] = []
        for corner in reversed(self._corners):
            if corner.time <= start:
                break
            inner.append(corner)
        pieces: list[Turn] = []
        heading = self.heading_at(start)
        for corner in reversed(inner):
            if corner.time >= end:
                pieces.append(Turn(self.heading_at(end) - heading, self.pivot_at(end)))
                break
            pieces.append(Turn(corner.heading - heading, corner.pivot))
            heading = corner.heading
        return pieces
