"""What a pivot switch does to a simulated robot: an open-loop walk, straight ahead, with any plant.

The field turns to and fro by the sweep angle, held while its elevation swings over at each end, as the board does
it. No controller, no camera, no coils: the same field everywhere.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from statistics import fmean, stdev

from control.coils import command_field
from control.model import PIVOT_A, PIVOT_B, Pivot, Pose, opposite, pivot_point, wrap
from control.simulation.plants import Plant, PlantChoice, build_plant

TICK = 1e-3
"""The board's, s."""
SETTLING = 0.03
"""Rest after a ramp and after a sweep before the robot is looked at, s: twice the table's time of settling."""
TAKING_UP = 0.3
"""In which the field rises at first, s; the board's own."""
UNCOUNTED = 2
"""First switches, while the robot finds into its stride."""

Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Stride:
    """sweep, tilt: rad.  rate: of the turning field, rad/s.  ramp: of the elevation from end to end, s.  field: T."""

    tilt: float
    sweep: float = math.radians(30.0)
    rate: float = 1.0
    ramp: float = 0.05
    field: float = 10e-3


@dataclass(frozen=True, slots=True)
class Switch:
    """One sweep and the switch after it.

    out, forward: how far the new pivot landed from where it would be had the old one stood still since its own
    landing, along the body away from its centre and in the walking direction, m.  hop: of `out`, what came during
    the switch itself, m.  lag: of the body behind the turning field at the sweep's end, rad.  tilt: of the raised
    end before the switch, rad.
    """

    out: float
    forward: float
    hop: float
    lag: float
    tilt: float


@dataclass(frozen=True, slots=True)
class Spread:
    mean: float
    deviation: float

    @classmethod
    def of(cls, values: Sequence[float]) -> Spread:
        return cls(fmean(values), stdev(values) if len(values) > 1 else 0.0)


@dataclass(frozen=True, slots=True)
class SwitchFigures:
    """Of all switches of a survey. play: free play between field and body, full width, rad.  out, forward, hop: m.

    displacement: sqrt(out^2 + forward^2), m.  advance: of the centre along the walk, as a share of what a robot that
    does not slip would do.
    """

    play: Spread
    out: Spread
    forward: Spread
    hop: Spread
    displacement: Spread
    tilt: Spread
    advance: float


def survey(
    choice: PlantChoice, length: float, stride: Stride, switches: int, seeds: Sequence[int]
) -> SwitchFigures:
    """Walk `switches` switches with each of the seeds. length: between the pivots, m."""
    seen: list[Switch] = []
    advances = []
    for seed in seeds:
        walk = OpenLoopWalk(build_plant(choice, length, Pose(0.0, 0.0, 0.0), seed), length, stride)
        walk.begin()
        seen += walk.switches(switches)
        advances.append(walk.advance_share)
    return SwitchFigures(
        play=Spread.of([2.0 * switch.lag for switch in seen]),
        out=Spread.of([switch.out for switch in seen]),
        forward=Spread.of([switch.forward for switch in seen]),
        hop=Spread.of([switch.hop for switch in seen]),
        displacement=Spread.of([math.hypot(switch.out, switch.forward) for switch in seen]),
        tilt=Spread.of([switch.tilt for switch in seen]),
        advance=fmean(advances),
    )


class OpenLoopWalk:
    """One robot on a straight walk along +x: the field's heading swings about 0 by half the sweep to either side."""

    def __init__(self, plant: Plant, length: float, stride: Stride) -> None:
        self.plant = plant
        self.length = length
        self.stride = stride
        self.pivot: Pivot = PIVOT_A
        self.heading = 0.0
        self.advance_share = math.nan
        self._lag = math.nan
        self._landed: Point = (math.nan, math.nan)

    def begin(self) -> None:
        """Take the robot up, and make the first half sweep."""
        ticks = _ticks(TAKING_UP)
        for tick in range(ticks):
            self._hold(self._elevation(self.pivot), (tick + 1) / ticks)
        self._rest()
        self._landed = pivot_point(self.plant.pose, self.pivot, self.length)
        self._turn_to(0.5 * self.stride.sweep)
        for _ in range(UNCOUNTED):
            self._next()

    def switches(self, count: int) -> Iterator[Switch]:
        """The next switches, each followed by the sweep to the other side."""
        start = self.plant.position
        for _ in range(count):
            yield self._next()
        moved = math.hypot(self.plant.position[0] - start[0], self.plant.position[1] - start[1])
        # Without slip the centre goes L sin(sweep / 2) with each sweep, in the direction in which it faces midway.
        ideal = count * self.length * math.sin(0.5 * self.stride.sweep)
        self.advance_share = moved / ideal

    def _next(self) -> Switch:
        before, tilt, lag = self.plant.pose, self.plant.body_tilt, self._lag
        slid = self._moved(self._landed, pivot_point(before, self.pivot, self.length), before.heading)
        self._switch()
        planned = pivot_point(before, self.pivot, self.length)
        self._rest()
        self._landed = pivot_point(self.plant.pose, self.pivot, self.length)
        along, forward = self._moved(planned, self._landed, before.heading)
        hop, slid_out = self.pivot * along, self.pivot * slid[0]
        self._turn_to(0.5 * self.stride.sweep * self.pivot)
        return Switch(hop + slid_out, forward + slid[1], hop, lag, tilt)

    @staticmethod
    def _moved(start: Point, end: Point, heading: float) -> Point:
        """From `start` to `end` (m): towards end A of a body with this heading, and forward."""
        dx, dy = end[0] - start[0], end[1] - start[1]
        cosine, sine = math.cos(heading), math.sin(heading)
        return cosine * dy - sine * dx, cosine * dx + sine * dy

    def _switch(self) -> None:
        before, self.pivot = self._elevation(self.pivot), opposite(self.pivot)
        after, ticks = self._elevation(self.pivot), _ticks(self.stride.ramp)
        for tick in range(ticks):
            self._hold(before + (after - before) * (tick + 1) / ticks)

    def _turn_to(self, goal: float) -> None:
        turn = goal - self.heading
        start, ticks = self.heading, _ticks(abs(turn) / self.stride.rate)
        for tick in range(ticks):
            self.heading = start + turn * (tick + 1) / ticks
            self._hold(self._elevation(self.pivot))
        # Taken while the field still turns: friction creeps, so a body at rest comes after it.
        self._lag = math.copysign(1.0, turn) * wrap(self.heading - self.plant.pose.heading)
        self._rest()

    def _rest(self) -> None:
        for _ in range(_ticks(SETTLING)):
            self._hold(self._elevation(self.pivot))

    def _elevation(self, pivot: Pivot) -> float:
        """The field that presses end B points up, since the magnet's north is at end A."""
        return -pivot * self.stride.tilt

    def _hold(self, elevation: float, share: float = 1.0) -> None:
        # Seen from end B an elevation is the tilt that `command_field` wants, of either sign.
        self.plant.step(command_field(PIVOT_B, self.heading, elevation, share * self.stride.field), TICK)


def _ticks(seconds: float) -> int:
    return max(1, round(seconds / TICK))
