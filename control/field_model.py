"""What the board's field has been doing: the host's mirror of the board between telemetry messages.

The board integrates the heading by itself and stops at the goal, so the host has to know where the field
points at any recent instant: at a frame's capture time, and now. The motion is piecewise linear; the mirror
keeps its corner points and is compared with the board's own heading whenever telemetry comes.
"""

from __future__ import annotations

import math
from collections import deque
from itertools import islice

from control.field import HISTORY, Corner, Field, FieldTrace
from control.model import Pivot, wrap

CLOCK_DRIFT = 0.008
"""How fast the smallest seen transit time is forgotten, s/s: an UNO's processor runs on a ceramic resonator, which is
off by up to 0.5 %."""

BEYOND_ZERO = 1e-12
"""Elevation at which a ramp presses on the other end, rad: as good as none, and of the right sign."""

DISAGREEMENT = math.radians(2.0)
"""Mirror and board may differ by this: 10 ms of transit at 2 rad/s is 1.1 degrees, rad."""


class FieldModel(Field):
    """Heading and elevation of the field, as the board moves them."""

    def __init__(self, ramp: float, field_slew: float) -> None:
        """ramp: a full change of pivot, s.  field_slew: how fast the field comes up at arming, T/s."""
        super().__init__(ramp, field_slew)
        self._rate = 0.0
        self._offset = math.inf
        self._board_time = self._received_at = -math.inf
        self.reported_at = -math.inf
        """The time (s) that the board's newest report tells of, as far as is known."""
        self._untold = 0
        self._anew = False

    def trace(self) -> FieldTrace:
        """What there is to record of this tick; the next trace goes on from here."""
        untold = min(self._untold, len(self._corners))
        corners = tuple(islice(self._corners, len(self._corners) - untold, None))
        anew, self._untold, self._anew = self._anew, 0, False
        strength = self.strength_at(self._time)
        return FieldTrace(self._on, self._heading, self._elevation, strength, self._full_at, corners, anew)

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
        end, self._heading = turned_until(self._time, self._heading, self._goal, self._rate, time)
        return self._later(end)

    def _raise_or_lower(self, time: float) -> float:
        """The elevation ramp, in two pieces where it passes zero; the heading is held meanwhile."""
        speed = 2.0 * abs(self._target_elevation) / self._ramp if self._target_elevation else math.inf
        end, self._elevation = raised_until(self._time, self._elevation, self._target_elevation, speed, time)
        return self._later(end)

    def _later(self, time: float) -> float:
        """Two corners are never at the same time, between which nothing could be told."""
        return max(time, math.nextafter(self._time, math.inf))

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


def turned_until(time: float, heading: float, goal: float, rate: float, until: float) -> tuple[float, float]:
    """The heading (rad) after turning to the goal from `time` on, and when that ends: `until` (s) at the latest."""
    left = goal - heading
    if left * rate <= 0.0:
        return until, heading
    arrival = time + left / rate
    if arrival <= until:
        return arrival, goal
    return until, heading + rate * (until - time)


def raised_until(
    time: float, elevation: float, target: float, speed: float, until: float
) -> tuple[float, float]:
    """The elevation (rad) after one straight piece of its ramp at `speed` (rad/s), and when that ends, s.

    A piece ends just beyond zero, where the other end is taken, on the target, or at `until`.
    """
    end = math.copysign(BEYOND_ZERO, target) if elevation * target < 0.0 else target
    arrival = time + abs(end - elevation) / speed
    if arrival <= until:
        return arrival, end
    return until, elevation + math.copysign(speed * (until - time), end - elevation)
