"""The robot's kinematic plants: how the body follows the field, with the slip of a rigid body or without.

Both are one class: `NO_SLIP` gives the paper's section 2 exactly, `SLIP_TABLE` adds what a rigid-body study
of the gait showed to matter. Known: the table. Assumed: each of the constants below, and that a robot taken
up out of rest does not slip. The table was fitted at Lambda = 3.2 for sweeps of 15 to 40 degrees (at 10
degrees it walks too far); outside its tilts the nearest row holds. Where the best tilt lies follows from the
choice of Lambda; it is no prediction.
"""

from __future__ import annotations

import math
import random
from dataclasses import dataclass

from control.model import PIVOT_A, PIVOT_B, Pivot, Pose, pivot_point, wrap
from control.simulation.slip import Slip, SlipParameters
from control.snapshot import Vector

REST_FIELD = 0.5e-3
"""Horizontal field below which friction holds the robot where it is, T (assumed)."""

ALIGNMENT_RATE = 30.0
"""Fastest turn of the body towards the field, rad/s (assumed; far above any commanded rate, 2 rad/s)."""

PRESSING_ELEVATION = math.radians(1.0)
"""Elevation of the field that presses an end down, rad (assumed); nearer to the plate the pivot stays."""

SETTLED_BAND = math.radians(1.0)
LONGEST_FITTED_SWEEP = math.radians(40.0)
"""The table was fitted to sweeps up to here; after a longer turn about one pivot the landing slips no further."""
SETTLED_AFTER = 0.02
"""The elevation is settled when it has kept within the band (rad) for this long, s (assumed). A ramp between
the pivots leaves the band sooner: at the slowest, +-10 degrees in 150 ms, in 8 ms."""


@dataclass(frozen=True, slots=True)
class PlantCounters:
    """switches: changes of pivot.  turned: sum of all turns, rad.  slipped: sum of all displacements, m."""

    switches: int
    turned: float
    slipped: float


class SlipPlant:
    """A pivot walker in the field at its place.

    length: between the pivots, m.  start: where it lies at first.  seed: of the friction's scatter, which is
    drawn only when a pivot is taken, so that equal fields give equal walks.
    """

    def __init__(self, parameters: SlipParameters, length: float, start: Pose, seed: int = 0):
        if not (math.isfinite(length) and length > 0.0):
            raise ValueError(f"the robot's length must be a finite number of m above 0, got {length}")
        self.parameters = parameters
        self.length = length
        self._random = random.Random(seed)
        self._switches = 0
        self._turned = 0.0
        self._slipped = 0.0
        self._pivot: Pivot = PIVOT_A
        self.place(start)

    @property
    def pose(self) -> Pose:
        return Pose(self._x, self._y, self._heading)

    @property
    def position(self) -> tuple[float, float]:
        """The centre, m."""
        return self._x, self._y

    @property
    def pivot(self) -> Pivot:
        """The end that is pressed down, or was last."""
        return self._pivot

    @property
    def body_tilt(self) -> float:
        """Elevation b of the raised end, rad: Lambda sin(a - b) = cos b once Lambda sin a > 1, else 0.

        a is the field's elevation at the robot; Lambda = 2 m B / (W L) grows with the field's strength.
        """
        ratio = self.parameters.magnetic_ratio / self.parameters.reference_field
        lift = ratio * self._vertical - 1.0
        return math.atan2(lift, ratio * self._horizontal) if lift > 0.0 else 0.0

    @property
    def counters(self) -> PlantCounters:
        return PlantCounters(self._switches, self._turned, self._slipped)

    def place(self, pose: Pose) -> None:
        """Lay the robot down flat at `pose`, at rest until the field takes it up."""
        if not pose.is_finite:
            raise ValueError(f"the robot can only be placed at a finite pose (m, m, rad), got {pose}")
        self._x, self._y, self._heading = pose.x, pose.y, pose.heading
        self._play = 0.0
        self._settled = self._held = self._held_for = 0.0
        self._stand_on(self._pivot)
        self._rest()

    def step(self, field: Vector, dt: float) -> None:
        """Move through `dt` (s) in `field` (T, at the robot: x and y in the plate, z up)."""
        bx, by, bz = field
        horizontal = math.hypot(bx, by)
        if not (REST_FIELD <= horizontal < math.inf and -math.inf < bz < math.inf):
            self._rest()
            return
        self._horizontal = horizontal
        self._vertical = abs(bz)
        # The magnet's north is at end A, a quarter turn left of the walking direction.
        self._obey(math.atan2(-bx, by), math.atan2(bz, horizontal), dt)

    def step_towards(self, heading: float, elevation: float, strength: float, dt: float) -> None:
        """`step` in a field given by its direction (rad, the robot's heading and elevation) and strength (T)."""
        horizontal = strength * math.cos(elevation)
        if not (REST_FIELD <= horizontal < math.inf and math.isfinite(heading)):
            self._rest()
            return
        self._horizontal = horizontal
        self._vertical = abs(strength * math.sin(elevation))
        self._obey(heading, elevation, dt)

    def _obey(self, heading: float, elevation: float, dt: float) -> None:
        if not -PRESSING_ELEVATION < elevation < PRESSING_ELEVATION:
            pressed = PIVOT_B if elevation > 0.0 else PIVOT_A
            if self._resting:
                self._take_up(pressed, abs(elevation))
            elif pressed != self._pivot:
                self._switch_to(pressed)
        self._settled, self._held, self._held_for = watch_elevation(
            self._settled, self._held, self._held_for, elevation, dt
        )
        turn = turn_towards(self._heading, heading, self._play, dt)
        if turn:
            self._heading += turn
            self._turned += abs(turn)
            arm = 0.5 * self.length * self._pivot
            self._x, self._y = hung_on(self._pivot_x, self._pivot_y, self._heading, arm)

    def _rest(self) -> None:
        self._resting = True
        self._horizontal = self._vertical = 0.0

    def _take_up(self, pivot: Pivot, elevation: float) -> None:
        """Out of rest the field comes slowly and the robot lies on both ends: no slip."""
        self._resting = False
        self._settled = elevation
        slip = self.parameters.at(elevation, self.length)
        self._play = self._draw_play(slip)
        self._stand_on(pivot)

    def _switch_to(self, pivot: Pivot) -> None:
        slip = self.parameters.at(self._settled, self.length)
        sweep = self._heading - self._sweep_start
        forward = mean_forward(self._pivot, sweep, slip.forward_base, slip.forward_per_sweep)
        self._slide(
            towards_a=pivot * self._random.gauss(slip.out, slip.out_sd),
            forward=self._random.gauss(forward, slip.forward_sd),
        )
        self._play = self._draw_play(slip)
        self._switches += 1
        self._stand_on(pivot)

    def _draw_play(self, slip: Slip) -> float:
        return max(0.0, self._random.gauss(slip.play, slip.play_sd))

    def _slide(self, towards_a: float, forward: float) -> None:
        """Shift the body by `towards_a` along its long axis and `forward` along its heading, m."""
        self._x, self._y = slid(self._x, self._y, self._heading, towards_a, forward)
        self._slipped += math.hypot(towards_a, forward)

    def _stand_on(self, pivot: Pivot) -> None:
        """Make `pivot` the fixed point, where it is now."""
        self._pivot = pivot
        self._pivot_x, self._pivot_y = pivot_point(self.pose, pivot, self.length)
        self._sweep_start = self._heading


def watch_elevation(
    settled: float, held: float, held_for: float, elevation: float, dt: float
) -> tuple[float, float, float]:
    """The elevation that the field has settled at, and the one it has kept (rad) and for how long (s), after `dt`."""
    if not -SETTLED_BAND <= elevation - held <= SETTLED_BAND:
        return settled, elevation, 0.0
    after = held_for + dt
    if held_for >= SETTLED_AFTER:
        # Smoothed, because a ramp begins inside the band.
        settled += (abs(elevation) - settled) * min(1.0, dt / SETTLED_AFTER)
    elif after >= SETTLED_AFTER:
        settled = abs(elevation)
    return settled, held, after


def turn_towards(heading: float, field_heading: float, play: float, dt: float) -> float:
    """The body's turn (rad) about its pivot until the field leads by half the play at most (the play operator)."""
    lead, slack = field_heading - heading, 0.5 * play
    if not -math.pi <= lead < math.pi:
        lead = wrap(lead)
    if -slack <= lead <= slack:
        return 0.0
    furthest = ALIGNMENT_RATE * dt
    return min(max(lead - math.copysign(slack, lead), -furthest), furthest)


def hung_on(pivot_x: float, pivot_y: float, heading: float, arm: float) -> tuple[float, float]:
    """The centre (m) at the arm's length (m, signed) from the fixed pivot.

    No rounding adds up: the exact arc of the paper's eq. (1).
    """
    return pivot_x + arm * math.sin(heading), pivot_y - arm * math.cos(heading)


def mean_forward(pivot: float, sweep: float, base: float, per_sweep: float) -> float:
    """How far in the walking direction the next pivot lands on average after `sweep` (rad) about this one, m.

    Walking is forward when the pivot's sign and the turn's agree (paper, section 2).
    """
    direction = pivot * math.copysign(1.0, sweep) if sweep else 0.0
    return direction * (base + per_sweep * min(abs(sweep), LONGEST_FITTED_SWEEP))


def slid(x: float, y: float, heading: float, towards_a: float, forward: float) -> tuple[float, float]:
    """The centre after a slide along the long axis and along the heading, all in m."""
    cosine, sine = math.cos(heading), math.sin(heading)
    return x + forward * cosine - towards_a * sine, y + forward * sine + towards_a * cosine
