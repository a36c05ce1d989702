"""How the robot turns with the field: from the stations of a turn to what they show. Pure.

Three observations are made. The sense: the body
turns with the field (+1) or against it (-1). The offset: seen heading less the field's (sense +1), or their
sum (sense -1). The pressed end: the one that stays in place while the body turns, which should be the one
that the field is told to press down.

The camera sees no difference between the robot's ends. Their names come from how it was put down, and when
the field takes it up it may spin; so the names are carried over by the end that stayed pressed meanwhile.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

from control.model import PIVOT_A, PIVOT_B, Pivot, Pose, opposite, pivot_point, wrap

FOLLOWS = (0.6, 1.4)
"""Seen turn over the field's: the play takes a part of a short turn, unequal coils add one."""
STAYS_WITHIN = 0.35
"""The pressed end moves less than this share of what the free end does."""
ENDS: tuple[Pivot, Pivot] = (PIVOT_A, PIVOT_B)
SPUN_WITHIN = 0.4
"""After the field came up an end is the same as before within this share of the length."""


class Unclear(ValueError):
    """The robot's motion allows no verdict; the text says what was seen and what to try."""


@dataclass(frozen=True, slots=True)
class Station:
    """The robot at rest in a field that stands still.

    field_heading: as commanded, rad, unwrapped.  pivot: the end told to be pressed.
    direction: +1 after a turn of the field to the left, -1 to the right.  pose: as seen, m, m, rad.
    """

    field_heading: float
    pivot: Pivot
    direction: int
    pose: Pose


@dataclass(frozen=True, slots=True)
class Evidence:
    """sense: +1 or -1.  offset: rad in [-pi, pi).  presses_right_end: the end that stays is the one commanded.

    names_are_sure: the ends could be followed while the field took the robot up.
    """

    sense: int
    offset: float
    presses_right_end: bool
    names_are_sure: bool


def gather(before: Pose, stations: Sequence[Station], length: float) -> Evidence:
    """What the turn shows; raises `Unclear`.

    before: as put down, its heading by the hint.  length: between the pivots, m.
    """
    sense = _sense(stations)
    pivots: set[Pivot] = {station.pivot for station in stations}
    stays: dict[Pivot, Pivot] = {pivot: _staying_end(stations, pivot, length) for pivot in pivots}
    if len({pivot * stays[pivot] for pivot in stays}) != 1:
        raise Unclear("the same end stays pressed whichever is commanded; is the z coils' current flowing?")
    presses_right_end = all(pivot == stays[pivot] for pivot in stays)
    offset = _circular_mean([wrap(s.pose.heading - sense * s.field_heading) for s in stations])
    carried = _name_after_spin(before, stations[0], stays[stations[0].pivot], length)
    if carried == opposite(stays[stations[0].pivot]):
        offset, presses_right_end = wrap(offset + math.pi), not presses_right_end
    return Evidence(sense, offset, presses_right_end, carried is not None)


def _sense(stations: Sequence[Station]) -> int:
    """+1 when the body turns with the field; from turns of one direction, so that the play does not count."""
    seen = turned = 0.0
    for earlier, later in itertools.pairwise(stations):
        if earlier.direction == later.direction and earlier.pivot == later.pivot:
            step = later.field_heading - earlier.field_heading
            turned += abs(step)
            seen += math.copysign(1.0, step) * wrap(later.pose.heading - earlier.pose.heading)
    if not (turned > 0.0 and FOLLOWS[0] <= abs(seen) / turned <= FOLLOWS[1]):
        raise Unclear(
            f"the field turned by {math.degrees(turned):.0f} degrees and the robot by {math.degrees(seen):+.0f}: "
            "it does not follow; check that it is free, that its magnet is in, and that all coils carry current"
        )
    return 1 if seen > 0.0 else -1


def _staying_end(stations: Sequence[Station], pivot: Pivot, length: float) -> Pivot:
    """The end, by its seen name, that stays in place while the field presses `pivot`."""
    poses = [station.pose for station in stations if station.pivot == pivot]
    moved: dict[Pivot, float] = {
        end: _spread([pivot_point(pose, end, length) for pose in poses]) for end in ENDS
    }
    still = min(moved, key=lambda end: moved[end])
    if not moved[still] <= STAYS_WITHIN * moved[opposite(still)]:
        raise Unclear(
            f"both ends move while the robot turns ({moved[still] * 1e3:.1f} and "
            f"{moved[opposite(still)] * 1e3:.1f} mm): none is pressed down; use more tilt, or clean the plate"
        )
    return still


def _spread(points: Sequence[tuple[float, float]]) -> float:
    """Root mean square distance from the mean, m."""
    x = sum(point[0] for point in points) / len(points)
    y = sum(point[1] for point in points) / len(points)
    return math.sqrt(sum((px - x) ** 2 + (py - y) ** 2 for px, py in points) / len(points))


def _name_after_spin(before: Pose, first: Station, pressed: Pivot, length: float) -> Pivot | None:
    """The name, by how the robot was put down, of the end that is pressed at the first station."""
    x, y = pivot_point(first.pose, pressed, length)
    for end in ENDS:
        at_x, at_y = pivot_point(before, end, length)
        if math.hypot(x - at_x, y - at_y) <= SPUN_WITHIN * length:
            return end
    return None


def _circular_mean(angles: Sequence[float]) -> float:
    return math.atan2(sum(map(math.sin, angles)), sum(map(math.cos, angles)))
