"""The board and the robot of a batch run: the field does what it is told, at once and where the robot is.

What the complete simulated rig has and a batch run has not: camera, noise and latency (the estimate is the truth),
serial line and coil currents (a command counts from the tick on, the currents follow at once), and the coils'
limits. The allocation is local, so the field has its commanded direction wherever the robot is; where a limit would
hold a current back, in the corners of the plate, the direction stays too and the slip plants ask for no more.
"""

from __future__ import annotations

import math

from control.backlash import ENGAGED_AFTER, Backlash, pull_after
from control.field import Corner
from control.field_model import FieldModel
from control.gait import Gait
from control.model import PIVOT_A, TURN, Pose, wrap
from control.simulation.plant import SlipPlant
from control.simulation.plants import Plant
from control.snapshot import Vector
from control.walker import Stride

RATE = 60.0
"""Ticks per second: the camera's pictures on the shipped rig."""
TICK = 1.0 / RATE
STEP = 1e-3
"""Longest time for which the robot's field is taken as constant, s: the board's tick and the simulated world's."""
REST = 0.1
"""How long the field stands still before the walk begins, s: twice what a plant needs to see that it is settled."""
OVERSHOOT = 0.002
"""So far beyond the workspace's edge a rig lets the centre go before it holds, m: the rig file's soft margin."""
WHOLE_STEPS = 1e-6
"""A piece that is longer than whole steps by rounding alone, in steps, gets no further one."""


class Bench:
    """Robot and field; `advance` moves both, `obey` is a drive command, `lead` is what the walker asks for."""

    def __init__(self, plant: Plant, gait: Gait, ramp: float) -> None:
        """ramp: of the elevation, for a full change of pivot, s."""
        self.field = FieldModel(ramp, math.inf)
        self.pose = plant.pose
        self._plant = plant
        self._gait = gait
        self._backlash = Backlash()
        self._pull = 0.0
        self.field.start(0.0, self.pose.heading, PIVOT_A, gait.tilt, gait.field)
        self._corner = self.field.trace().corners[-1]
        self._follow(self._corner, STEP)

    @property
    def now(self) -> float:
        """s; 0 is when the field came up."""
        return self._corner.time

    def lead(self, direction: float) -> float:
        """How far the field has to go beyond the body's goal, as far as the walk has shown, rad."""
        return self._backlash.lead(direction)

    def obey(self, stride: Stride) -> None:
        self.field.command(stride.pivot, self._gait.tilt, stride.rate, stride.heading_goal)

    def advance(self, now: float) -> None:
        """Move on to `now` (s) and look."""
        before = self._corner
        self.field.advance(now)
        for corner in self.field.trace().corners:
            self._sweep_to(corner)
        self.pose = _unwrapped(self._plant.pose, self.pose.heading)
        self._see(self._corner.heading - before.heading)

    def _sweep_to(self, corner: Corner) -> None:
        """Lead the robot along a straight piece of the field's motion, in steps."""
        start, self._corner = self._corner, corner
        elapsed = corner.time - start.time
        count = max(1, math.ceil(elapsed / STEP - WHOLE_STEPS))
        for number in range(1, count + 1):
            share = number / count
            heading = start.heading + share * (corner.heading - start.heading)
            elevation = start.elevation + share * (corner.elevation - start.elevation)
            self._follow(Corner(corner.time, heading, elevation), elapsed / count)

    def _follow(self, corner: Corner, dt: float) -> None:
        if isinstance(self._plant, SlipPlant):
            self._plant.step_towards(corner.heading, corner.elevation, self._gait.field, dt)
        else:
            self._plant.step(_field(corner.heading, corner.elevation, self._gait.field), dt)

    def _see(self, angle: float) -> None:
        """The field has turned by `angle` (rad): while it surely pulls the body, its lead shows."""
        self._pull = pull_after(self._pull, angle)
        if abs(self._pull) >= ENGAGED_AFTER:
            lag = wrap(self._corner.heading - self.pose.heading)
            self._backlash.observe(1 if self._pull > 0.0 else -1, lag)


def _field(heading: float, elevation: float, strength: float) -> Vector:
    """The field (T) of a heading of the robot, rad: the magnet's north is at end A."""
    level = strength * math.cos(elevation)
    return -level * math.sin(heading), level * math.cos(heading), strength * math.sin(elevation)


def _unwrapped(pose: Pose, near: float) -> Pose:
    """The same pose with the heading that is nearest to `near`, rad."""
    turns = round((near - pose.heading) / TURN)
    return Pose(pose.x, pose.y, pose.heading + turns * TURN) if turns else pose
