"""The rigid robot in its field: MuJoCo's body behind the plants' interface."""

from __future__ import annotations

import math

from control.model import PIVOT_A, PIVOT_B, Pivot, Pose, wrap
from control.simulation.plant import PlantCounters
from control.simulation.rigid.attitude import Attitude
from control.simulation.rigid.engine import Engine
from control.simulation.rigid.model import BALL, CENTRE_HEIGHT, PER_METRE, SUBSTEP, balls
from control.simulation.rigid.parameters import RigidParameters
from control.simulation.rigid.plate import Plate
from control.snapshot import ZERO, Vector

LOOK = 5
"""Substeps between two looks at the body: 1 ms. The friction under the feet changes at a look."""
LIFTED = math.radians(0.1)
"""From this tilt on it is the lower end that is pressed, rad; below, the one that the field presses (assumed)."""
PRESSING_FIELD = 1e-4
"""Vertical field that presses an end down while both touch, T (1 % of the nominal field; assumed)."""
NO_FIELD = 1e-6
"""Field that moves nothing, T: its torque is a ten-thousandth of the one that lifts an end."""
AT_REST = 1e-3
"""Speed of a body that lies still, mm/s and rad/s: a resting body is not computed."""
SINKING = 100
"""Substeps in which a body that was laid down has come to rest: 20 ms, twenty times the contacts' time constant."""


HIGHEST = 3.0
"""How far the centre of a body that walks never rises, in lengths; upright on one end it has risen by half of one."""


class Diverged(ValueError):
    """The body's motion cannot be computed for these parameters."""


class RigidPlant:
    """A pivot walker that obeys mechanics alone. length: between the feet, m.  seed: of the plate's friction.

    The time is kept in whole substeps, so that equal fields give equal motions however the time is cut.
    """

    def __init__(self, parameters: RigidParameters, length: float, start: Pose, seed: int = 0) -> None:
        if not (math.isfinite(length) and length > 0.0):
            raise ValueError(f"the robot's length must be a finite number of m above 0, got {length}")
        self.parameters = parameters
        self.length = length
        self.plate = Plate(parameters, seed)
        self.engine = Engine(parameters, length)
        self._balls = balls(parameters, length)
        self._highest = HIGHEST * length * PER_METRE + CENTRE_HEIGHT
        self._laid: list[float] = []
        self._switches = 0
        self._turned = self._slipped = 0.0
        self._pivot: Pivot = PIVOT_A
        self.place(start)

    @property
    def pose(self) -> Pose:
        return Pose(self._x, self._y, self._heading)

    @property
    def position(self) -> tuple[float, float]:
        """The centre, m, as if the robot lay flat on its pressed end."""
        return self._x, self._y

    @property
    def pivot(self) -> Pivot:
        """The end that is pressed down, or was last."""
        return self._pivot

    @property
    def body_tilt(self) -> float:
        """Elevation of the raised end, rad."""
        return abs(self._pitch)

    @property
    def counters(self) -> PlantCounters:
        """slipped: how far the pressed end has slid over the plate, m."""
        return PlantCounters(self._switches, self._turned, self._slipped)

    def place(self, pose: Pose) -> None:
        """Lay the robot down flat and still at `pose`."""
        if not pose.is_finite:
            raise ValueError(f"the robot can only be placed at a finite pose (m, m, rad), got {pose}")
        self._field: Vector = ZERO
        self._is_resting, self._is_pulled = True, False
        self._owed = 0.0
        self._substeps = 0
        self._foot: tuple[float, float] | None = None
        self._heading = pose.heading
        self._laid = []
        self.engine.reset()
        self._lie_at(pose, CENTRE_HEIGHT)
        # Adhesion holds only what touches, so the feet must have sunk in before a field comes.
        self.engine.advance(SINKING)
        self._lie_at(pose, float(self.engine.state[2]))

    def _lie_at(self, pose: Pose, height: float) -> None:
        """height: of the centre, mm."""
        half = 0.5 * pose.heading
        place = pose.x * PER_METRE, pose.y * PER_METRE, height
        self.engine.state[:] = (*place, math.cos(half), 0.0, 0.0, math.sin(half))
        self.engine.speed[:] = 0.0
        self._look()

    def step(self, field: Vector, dt: float) -> None:
        """Move through `dt` (s) in `field` (T, at the robot: x and y in the plate, z up)."""
        strength = math.hypot(*field)
        self._is_pulled = NO_FIELD <= strength < math.inf
        if self._is_resting and not self._is_pulled:
            return
        self._field = field if self._is_pulled else ZERO
        self.engine.set_field(self._field)
        self._is_resting = False
        self._owed += dt
        # A millionth of a substep: 0.001 s / 0.2 ms must be 5, though it may round to less.
        due = math.floor(self._owed / SUBSTEP + 1e-6)
        self._owed -= due * SUBSTEP
        while due > 0 and not self._is_resting:
            count = min(due, LOOK - self._substeps % LOOK)
            self.engine.advance(count)
            due -= count
            self._substeps += count
            if self._substeps % LOOK == 0:
                self._look()

    def _look(self) -> None:
        """Take the pose from the body's state, and give the feet the friction of where they are."""
        state = self.engine.state.tolist()
        if not (all(map(math.isfinite, state)) and 0.0 < state[2] < self._highest):
            raise Diverged(
                f"the rigid robot's motion cannot be computed, or it flew off its plate ({self.parameters}); "
                "choose a weaker magnet, a heavier body, less adhesion or more damping"
            )
        body = Attitude.of(state)
        self._watch_turn(body)
        self._watch_ends(body)
        if not self._is_pulled:
            self._watch_rest()
        if not self.plate.is_even:
            self._lay_friction(body)

    def _watch_turn(self, body: Attitude) -> None:
        turn = wrap(body.heading - self._heading)
        self._heading += turn
        self._turned += abs(turn)
        self._pitch = body.pitch

    def _watch_ends(self, body: Attitude) -> None:
        """Which end is pressed, where it stands, and how far it has slid since the last look."""
        pressing = self._pitch if abs(self._pitch) >= LIFTED else self._field[2] / PRESSING_FIELD * LIFTED
        if abs(pressing) >= LIFTED:
            self._press(PIVOT_B if pressing > 0.0 else PIVOT_A)
        reach = 0.5 * self.length * PER_METRE * self._pivot
        x, y = body.at(0.0, reach, BALL - CENTRE_HEIGHT)
        if self._foot is not None:
            self._slipped += math.hypot(x - self._foot[0], y - self._foot[1]) / PER_METRE
        self._foot = x, y
        self._x = (x + reach * math.sin(self._heading)) / PER_METRE
        self._y = (y - reach * math.cos(self._heading)) / PER_METRE

    def _press(self, pivot: Pivot) -> None:
        if pivot != self._pivot:
            self._pivot = pivot
            self._switches += 1
            self._foot = None

    def _watch_rest(self) -> None:
        if max(map(abs, self.engine.speed.tolist())) < AT_REST:
            self._is_resting = True
            self._owed = 0.0

    def _lay_friction(self, body: Attitude) -> None:
        laid = [self.plate.friction_at(*body.at(*place)) for place in self._balls]
        if laid != self._laid:
            self._laid = laid
            self.engine.friction[:, 0] = self.engine.friction[:, 1] = laid
