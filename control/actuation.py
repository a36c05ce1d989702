"""The one way to the coils: strides become drive commands here, within the limits, and stop here.

Nothing else on the host may energise a coil. A stop may come from any thread at any time; once it has come
from outside the loop, no drive leaves until it is cleared by a deliberate reset.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from control.coils import CoilSet, Matrix, command_field, currents_for, limit_currents
from control.field_model import FieldModel
from control.gait import Gait
from control.link.conversion import DriveCommand
from control.link.port import Link
from control.model import PIVOT_A, Pivot, Pose
from control.snapshot import Command, Vector
from control.walker import Stride

FARTHEST_GOAL = math.radians(150.0)
"""A goal is given to the board at most this far ahead: it takes the shorter way round."""


@dataclass(frozen=True, slots=True)
class ActuationSettings:
    """currents: limits, A.  time_to_live: of one command, s.  tick: nominal period, s.

    allocation: "local" holds field and tilt constant over the plate; "centre" is the paper's.
    """

    currents: Vector
    time_to_live: float
    tick: float
    allocation: Literal["local", "centre"] = "local"


class Actuation:
    """Field commands out, with the board's mirror (`FieldModel`) kept in step."""

    def __init__(self, link: Link, coils: CoilSet, field: FieldModel, settings: ActuationSettings) -> None:
        self._link = link
        self._coils = coils
        self._field = field
        self._settings = settings
        self._stopped_from_outside = False
        self.saturated = False
        self.command = _idle("", PIVOT_A)

    def stop_from_outside(self) -> None:
        """Zero now, from any thread or signal handler, and keep it so until `allow` is called; never waits."""
        self._stopped_from_outside = True
        self._link.stop()

    @property
    def stopped_from_outside(self) -> bool:
        return self._stopped_from_outside

    def allow(self) -> None:
        """The operator has reset the stop; nothing is driven by that alone."""
        self._stopped_from_outside = False

    def start(self, now: float, pose: Pose, pivot: Pivot, gait: Gait) -> None:
        """The arm edge: the field comes up along the robot's own heading, so that it is not snapped round."""
        self._field.start(now, pose.heading, pivot, gait.tilt, gait.field)
        stride = Stride(pivot, 0.0, pose.heading)
        self._send("", stride, pose, gait, start_heading=pose.heading)

    def drive(self, controller: str, stride: Stride, pose: Pose, gait: Gait) -> None:
        """One tick's command; the caller has advanced the field model to now."""
        self._send(controller, stride, pose, gait, start_heading=None)
        self._field.command(stride.pivot, gait.tilt, stride.rate, self.command.heading_goal)

    def stop(self, now: float) -> None:
        """Zero the coils."""
        self._field.stop(now)
        self.saturated = False
        self.command = _idle("", self.command.pivot)
        self._link.stop()

    def _send(
        self, controller: str, stride: Stride, pose: Pose, gait: Gait, start_heading: float | None
    ) -> None:
        allocation = self._allocation(pose)
        heading = self._field.heading
        ahead = max(-FARTHEST_GOAL, min(FARTHEST_GOAL, stride.heading_goal - heading))
        field = gait.field * self._share_within_limits(allocation, heading, stride, gait)
        self.command = Command(controller, stride.pivot, stride.rate, heading + ahead, gait.tilt, field)
        drive = DriveCommand(
            pivot=stride.pivot,
            rate=stride.rate,
            heading_goal=heading + ahead,
            tilt=gait.tilt,
            field=field,
            allocation=allocation,
            time_to_live=self._settings.time_to_live,
            start_heading=start_heading,
        )
        if not self._stopped_from_outside:
            self._link.drive(drive)
        if self._stopped_from_outside:
            self._link.stop()  # it may have come between the question and the command

    def _allocation(self, pose: Pose) -> Matrix:
        if self._settings.allocation == "centre":
            return self._coils.centre_allocation()
        return self._coils.local_allocation(pose.x, pose.y)

    def _share_within_limits(self, allocation: Matrix, heading: float, stride: Stride, gait: Gait) -> float:
        """The share (0 .. 1] of the field that keeps every current within its limit until the next tick."""
        share = 1.0
        for at in (heading, heading + stride.rate * self._settings.tick):
            wanted = currents_for(allocation, command_field(stride.pivot, at, gait.tilt, gait.field))
            limited, scaled = limit_currents(wanted, self._settings.currents)
            if scaled:
                share = min(share, math.hypot(*limited) / math.hypot(*wanted))
        self.saturated = share < 1.0
        return share


def _idle(controller: str, pivot: Pivot) -> Command:
    return Command(controller, pivot, 0.0, 0.0, 0.0, 0.0)
