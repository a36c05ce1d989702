"""How the commanded field moves on the board from one millisecond to the next, in integers.

The heading (uint32, 2^32 = one turn) runs at its rate and stops exactly on its goal; the elevation (same
scale, signed) slews through a pivot switch while the heading is held; the strength (uT/256) slews too.
"""

from __future__ import annotations

from control.link import messages

_U32 = 0xFFFFFFFF
_HALF = 0x80000000


def signed(phase: int) -> int:
    """The 32-bit pattern as int32."""
    return ((phase + _HALF) & _U32) - _HALF


class FieldMotion:
    """heading: uint32 phase.  elevation: int32 phase.  magnitude: uT, Q8."""

    __slots__ = (
        "_elevation_goal",
        "_elevation_step",
        "_goal",
        "_magnitude_goal",
        "_ramp",
        "_rate",
        "_slew",
        "elevation",
        "heading",
        "magnitude",
    )

    def __init__(self) -> None:
        self.heading = self.elevation = self.magnitude = 0
        self._goal = self._rate = self._elevation_goal = self._elevation_step = self._magnitude_goal = 0
        self._ramp = self._slew = 0

    def configure(self, ramp: int, slew: int) -> None:
        """ramp: ms of a full elevation swing.  slew: uT/256 per ms.

        The quotient is rounded up, so that a swing takes the ramp's milliseconds and not one more.
        """
        self._ramp = (65536 + ramp - 1) // ramp
        self._slew = slew

    def rest(self) -> None:
        """No field: standing still at the heading where it was."""
        self.magnitude = self._magnitude_goal = self._rate = 0

    def start(self, drive: messages.Drive) -> None:
        """The arm edge: heading and elevation are set while the field is zero, and the field ramps up."""
        self.heading = drive.start_heading
        self.magnitude = 0
        self.elevation = (-drive.pivot * drive.tilt) << 16
        self.follow(drive)

    def follow(self, drive: messages.Drive) -> None:
        self._goal = drive.heading_goal
        self._rate = drive.rate
        self._magnitude_goal = drive.field << 8
        goal = (-drive.pivot * drive.tilt) << 16
        if goal != self._elevation_goal:
            self._elevation_goal = goal
            swing = max(1, max(abs(goal), abs(self.elevation)) >> 16)
            self._elevation_step = 2 * swing * self._ramp

    def advance(self) -> None:
        """One millisecond."""
        if self.elevation != self._elevation_goal:
            self.elevation = _towards(self.elevation, self._elevation_goal, self._elevation_step)
        elif self._rate:
            self._turn()
        if self.magnitude != self._magnitude_goal:
            self.magnitude = _towards(self.magnitude, self._magnitude_goal, self._slew)

    def _turn(self) -> None:
        """Towards the goal and never past it; a goal that lies behind means standing still."""
        rate = self._rate
        distance = ((self._goal - self.heading + _HALF) & _U32) - _HALF
        if rate > 0:
            if distance > rate:
                self.heading = (self.heading + rate) & _U32
            elif distance > 0:
                self.heading = self._goal
        elif distance < rate:
            self.heading = (self.heading + rate) & _U32
        elif distance < 0:
            self.heading = self._goal


def _towards(value: int, goal: int, step: int) -> int:
    """Compares distances, since value + step might leave 32 bits."""
    distance = goal - value
    if distance > step:
        return value + step
    if distance < -step:
        return value - step
    return goal
