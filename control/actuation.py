"""The one way to the coils: strides become drive commands here, within the limits, and stop here.

Nothing else on the host may energise a coil. A stop may come from any thread at any time; once it has come
from outside the loop, no drive leaves until it is cleared by a deliberate reset.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from control.axes import AXES
from control.coils import CoilSet, Matrix
from control.field_model import FieldModel
from control.gait import Gait
from control.limiter import CoilLimits, Granted, Wanted, check_field_slew, limit
from control.link.conversion import DriveCommand, LinkError
from control.link.port import Link
from control.model import PIVOT_A, Pivot, Pose
from control.snapshot import Command
from control.walker import Stride

FARTHEST_GOAL = math.radians(150.0)
"""A goal is given to the board at most this far ahead: it takes the shorter way round."""


@dataclass(frozen=True, slots=True)
class ActuationSettings:
    """limits: of the coils.  time_to_live: of one command, s.  tick: nominal period, s.

    allocation: "local" holds field and tilt constant over the plate; "centre" is the paper's.
    """

    limits: CoilLimits
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
        self.limited_by = ""
        """The limit that holds the newest command back, "" for none."""
        self.command = _idle("", PIVOT_A)

    @property
    def tick(self) -> float:
        """Nominal time between two commands, s."""
        return self._settings.tick

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
        self._field.command(stride.pivot, gait.tilt, self.command.rate, self.command.heading_goal)

    def hold_steady(self, drive: DriveCommand) -> None:
        """A calibration's command, sent as it is; `LinkError` when it would have to be held back."""
        self._refuse_beyond_limits(drive)
        if not self._stopped_from_outside:
            self._link.drive(drive)
        if self._stopped_from_outside:
            self._link.stop()  # it may have come between the question and the command

    def _refuse_beyond_limits(self, drive: DriveCommand) -> None:
        """Wherever the field may point on its way."""
        limits, elevation = self._settings.limits, -drive.pivot * drive.tilt
        for axis, row, allowed in zip(AXES, drive.allocation, limits.currents, strict=True):
            most = drive.field * math.hypot(*row)
            if not most <= allowed:
                raise LinkError(f"coil {axis} would carry up to {most:.3g} A; its limit is {allowed:g} A")
        wanted = Wanted(drive.heading_goal, drive.rate, elevation, elevation, drive.field)
        try:
            check_field_slew(drive.allocation, limits)
            granted = limit(wanted, drive.allocation, limits, self._settings.tick)
        except ValueError as error:
            raise LinkError(str(error)) from error
        if granted.limited_by:
            raise LinkError(f"this field is beyond the limit of the {granted.limited_by}; use less of it")

    def stop(self, now: float) -> None:
        """Zero the coils."""
        self._field.stop(now)
        self.limited_by = ""
        self.command = _idle("", self.command.pivot)
        self._link.stop()

    def _send(
        self, controller: str, stride: Stride, pose: Pose, gait: Gait, start_heading: float | None
    ) -> None:
        allocation = self._allocation(pose)
        heading = self._field.heading
        ahead = max(-FARTHEST_GOAL, min(FARTHEST_GOAL, stride.heading_goal - heading))
        granted = self._within_limits(allocation, stride, gait)
        self.limited_by = granted.limited_by
        self.command = Command(
            controller, stride.pivot, granted.rate, heading + ahead, gait.tilt, granted.field
        )
        drive = DriveCommand(
            pivot=stride.pivot,
            rate=granted.rate,
            heading_goal=heading + ahead,
            tilt=gait.tilt,
            field=granted.field,
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

    def _within_limits(self, allocation: Matrix, stride: Stride, gait: Gait) -> Granted:
        """Field and rate that keep every current within its limits until the next tick."""
        wanted = Wanted(
            heading=self._field.heading,
            rate=stride.rate,
            elevation=self._field.elevation,
            target=-stride.pivot * gait.tilt,
            field=gait.field,
        )
        return limit(wanted, allocation, self._settings.limits, self._settings.tick)


def _idle(controller: str, pivot: Pivot) -> Command:
    return Command(controller, pivot, 0.0, 0.0, 0.0, 0.0)
