"""What the board's field has been doing: the host's mirror of the board between telemetry messages.

The board integrates the heading by itself and stops at the goal, so the host has to know where the field
points at any recent instant: at a frame's capture time, and now. The motion is piecewise linear; the mirror
keeps its corner points and is compared with the board's own heading whenever telemetry comes.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from itertools import islice

from control.model import PIVOT_A, PIVOT_B, Pivot, wrap

HISTORY = 240
"""Corner points kept: more than a second of walking at 60 drives a second."""
CLOCK_DRIFT = 0.008
"""How fast the smallest seen transit time is forgotten, s/s: an UNO's processor runs on a ceramic resonator, which is
off by up to 0.5 %."""

DISAGREEMENT = math.radians(2.0)
"""Mirror and board may differ by this: 10 ms of transit at 2 rad/s is 1.1 degrees, rad."""


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


class FieldModel:
    """Heading and elevation of the field, as the board moves them."""

    def __init__(self, ramp: float, field_slew: float) -> None:
        """ramp: a full change of pivot, s.  field_slew: how fast the field comes up at arming, T/s."""
        self._ramp = ramp
        self._field_slew = field_slew
        self._on = False
        self._time = -math.inf
        self._heading = 0.0
        self._elevation = 0.0
        self._target_elevation = 0.0
        self._rate = 0.0
        self._goal = 0.0
        self._strength = 0.0
        self._full_at = math.inf
        self._offset = math.inf
        self._board_time = self._received_at = -math.inf
        self.reported_at = -math.inf
        """The time (s) that the board's newest report tells of, as far as is known."""
        self._corners: deque[Corner] = deque(maxlen=HISTORY)
        self._untold = 0
        self._anew = False

    def trace(self) -> FieldTrace:
        """What there is to record of this tick; the next trace goes on from here."""
        untold = min(self._untold, len(self._corners))
        corners = tuple(islice(self._corners, len(self._corners) - untold, None))
        anew, self._untold, self._anew = self._anew, 0, False
        strength = self.strength_at(self._time)
        return FieldTrace(self._on, self._heading, self._elevation, strength, self._full_at, corners, anew)

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

    def start(self, time: float, heading: float, pivot: Pivot, tilt: float, strength: float) -> None:
        """The arm edge: the field comes up from zero to `strength` (T), pointing along `heading` (rad)."""
        self.advance(time)
        self._on = True
        self._heading = self._goal = heading
        self._elevation = self._target_elevation = -pivot * tilt
        self._rate = 0.0
        self._strength = strength
        self._full_at = time + strength / self._field_slew
        self._corners.clear()
        self._corners.append(Corner(time, heading, self._elevation))
        self._untold, self._anew = 1, True

    def stop(self, time: float) -> None:
        """The field goes off; from here on it turns nothing."""
        self.advance(time)
        self._on = False
        self._rate = 0.0
        self._elevation = self._target_elevation = 0.0

    def command(self, pivot: Pivot, tilt: float, rate: float, goal: float) -> None:
        """A drive command that the board has just been sent."""
        self._target_elevation = -pivot * tilt
        self._rate = rate
        self._goal = goal

    def advance(self, time: float) -> None:
        """Move on to `time` (s)."""
        while self._time < time:
            self._time = self._next_piece(time)
            self._corners.append(Corner(self._time, self._heading, self._elevation))
            self._untold += 1

    def _next_piece(self, time: float) -> float:
        """Move along one straight piece that ends at `time` at the latest; returns when it ended."""
        if not math.isfinite(self._time) or not self._on:
            return time
        if self._elevation != self._target_elevation:
            return self._raise_or_lower(time)
        left = self._goal - self._heading
        if left * self._rate <= 0.0:
            return time
        arrival = self._time + left / self._rate
        if arrival <= time:
            self._heading = self._goal
            return max(arrival, math.nextafter(self._time, math.inf))
        self._heading += self._rate * (time - self._time)
        return time

    def _raise_or_lower(self, time: float) -> float:
        """The elevation ramp, in two pieces where it passes zero; the heading is held meanwhile."""
        speed = 2.0 * abs(self._target_elevation) / self._ramp if self._target_elevation else math.inf
        crosses = self._elevation * self._target_elevation < 0.0
        end = math.copysign(1e-12, self._target_elevation) if crosses else self._target_elevation
        arrival = self._time + abs(end - self._elevation) / speed
        if arrival <= time:
            self._elevation = end
            return max(arrival, math.nextafter(self._time, math.inf))
        self._elevation += math.copysign(speed * (time - self._time), end - self._elevation)
        return time

    def synchronise(self, board_time: float, received_at: float, heading: float) -> None:
        """Compare with the board's own heading (rad, wrapped) at its own time (s); follow it where they part.

        The mirror must have advanced to now. The board's clock is placed by the quickest message so far:
        transit can only add to the difference. What transit is left explains a small disagreement, and the
        mirror's own errors do not add up (every goal is absolute), so only a large one is believed: then
        the board has missed a command.
        """
        if board_time < self._board_time:
            self.forget_clock()
        forgotten = CLOCK_DRIFT * (received_at - self._received_at)
        self._board_time, self._received_at = board_time, received_at
        self._offset = min(self._offset + forgotten, received_at - board_time)
        self.reported_at = at = board_time + self._offset
        if not self._on or not self._corners or at < self._corners[0].time:
            return
        shift = wrap(heading - self.heading_at(at))
        if abs(shift) <= DISAGREEMENT:
            return
        self._heading += shift
        self._corners = deque(
            (Corner(c.time, c.heading + shift, c.elevation) for c in self._corners), maxlen=HISTORY
        )
        self._untold, self._anew = HISTORY, True

    def forget_clock(self) -> None:
        """The board's time begins again: it has restarted, or its count of milliseconds has gone round (49 days)."""
        self._offset = math.inf
        self.reported_at = -math.inf

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
