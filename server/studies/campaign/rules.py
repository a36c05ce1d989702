"""By which rules a campaign treats its rig: the `[rig]` table of a study's definition, in SI units."""

from __future__ import annotations

import math
from dataclasses import dataclass

from control.model import Pose, wrap
from control.studies.definition import StudyDefinition

MM = 1e-3
MINUTE = 60.0
SURE = 0.9
"""Share of the allowed distance within which the robot must be seen: the rest is the estimate's own error (0.1 mm of
1 mm is twice its deviation)."""
AIM = 0.5
"""Share of it that the way back aims at."""


@dataclass(frozen=True, slots=True)
class Rules:
    """rest: before each run, s.  within, within_heading: of the start, m and rad.  attempts: at each run.

    cool_to: share of the heat that no coil may exceed when a run begins.  patience: for what bars the way, s.
    """

    rest: float
    within: float
    within_heading: float
    attempts: int
    cool_to: float
    patience: float

    @classmethod
    def of(cls, definition: StudyDefinition) -> Rules:
        rig = definition.rig
        return cls(
            rest=rig.rest_s,
            within=rig.start_within_mm * MM,
            within_heading=math.radians(rig.start_within_deg),
            attempts=rig.attempts,
            cool_to=rig.cool_to_percent / 100.0,
            patience=rig.wait_minutes * MINUTE,
        )

    def is_at(self, pose: Pose | None, start: Pose) -> bool:
        """Whether the robot stands at the start; a pose that is none does not."""
        if pose is None:
            return False
        place, turn = off(pose, start)
        return place <= SURE * self.within and turn <= SURE * self.within_heading


def off(pose: Pose, start: Pose) -> tuple[float, float]:
    """How far a robot is from the start, m and rad."""
    return pose.distance_to(start.x, start.y), abs(wrap(pose.heading - start.heading))
