"""What is known of one robot's gait: its effective length, and what a pivot switch does to it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from control.model import Pivot, Pose

LARGEST_TURN = math.radians(40.0)
"""A longer turn about one pivot slips no further (physics.md: fitted to sweeps up to here), rad."""


@dataclass(frozen=True, slots=True)
class GaitUncertainty:
    """Standard errors of the fields of `GaitModel` that bear the same names, in their units."""

    length: float
    out: float
    forward_base: float
    forward_per_sweep: float
    backlash: float
    heading_offset: float
    lag: float
    skew: float


@dataclass(frozen=True, slots=True)
class GaitModel:
    """Mean effect of a pivot switch (physics: the robot slips while the field tips over).

    length: effective distance between the pivots, m.
    out: how far the new pivot lands from its place, along the link away from the centre, m.
    forward_base, forward_per_sweep: how far it lands in the walking direction, m and m/rad: base + per_sweep
    * |turn about the old pivot|.
    switch_time: the robot stands still for this long at a switch, s.
    backlash: play between the field's heading and the body's, full width, rad.
    heading_offset: of the field's heading beyond the seen one, in the middle of the play, rad.
    lag: the body comes after the field by this time while it is pulled along, beyond the known actuation delay, s.
    skew: of the body's heading, as its pivots have it, beyond the seen one, rad.
    uncertainty: None where the figures were not identified.
    """

    length: float
    out: float = 0.0
    forward_base: float = 0.0
    forward_per_sweep: float = 0.0
    switch_time: float = 0.0
    backlash: float = 0.0
    heading_offset: float = 0.0
    lag: float = 0.0
    skew: float = 0.0
    uncertainty: GaitUncertainty | None = None

    def forward(self, turn: float) -> float:
        """How far the new pivot lands in the walking direction after `turn` (rad) about the old one, m."""
        return self.forward_base + self.forward_per_sweep * min(abs(turn), LARGEST_TURN)

    def landed(self, pose: Pose, left: Pivot, turn: float) -> Pose:
        """The pose once the other pivot has been taken, after `turn` (rad) about the pivot `left`.

        Walking is forward when the pivot's sign and the turn's agree.
        """
        forward = left * math.copysign(self.forward(turn), turn) if turn else 0.0
        cosine, sine, out = math.cos(pose.heading), math.sin(pose.heading), left * self.out
        return Pose(
            pose.x + forward * cosine + out * sine, pose.y + forward * sine - out * cosine, pose.heading
        )
