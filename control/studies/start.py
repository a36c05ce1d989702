"""Where a run starts: the path's first point, heading along it, or what the definition says."""

from __future__ import annotations

import math
from dataclasses import replace

from control.model import Pose
from control.studies.sections import StartSection
from control.studies.seeds import generator
from control.trajectories.trajectory import Path

MM = 1e-3
START_DRAW = 2
"""Purpose of the random numbers for the starts' scatter."""
FIRST_LOOK = 1e-5
"""The direction of a path is first looked for after this share of it, then further on."""
SEEN = 1e-7
"""Two points this far apart (m) have a direction from one to the other."""


def start_of(section: StartSection, path: Path) -> Pose:
    """The start without scatter."""
    x, y = path.point(0.0)
    heading = along(path) if section.heading_deg is None else math.radians(section.heading_deg)
    return Pose(
        x if section.x_mm is None else section.x_mm * MM,
        y if section.y_mm is None else section.y_mm * MM,
        heading,
    )


def scattered(start: Pose, section: StartSection, study_seed: int, index: int) -> Pose:
    """The start of one run of a batch."""
    if not (section.scatter_mm or section.scatter_deg):
        return start
    x, y, turn = generator(study_seed, index, START_DRAW).standard_normal(3).tolist()
    return replace(
        start,
        x=start.x + x * section.scatter_mm * MM,
        y=start.y + y * section.scatter_mm * MM,
        heading=start.heading + turn * math.radians(section.scatter_deg),
    )


def along(path: Path) -> float:
    """The path's direction at its beginning, rad; 0 for a path that stays where it is."""
    x, y = path.point(0.0)
    share = FIRST_LOOK
    while share <= 1.0:
        ahead_x, ahead_y = path.point(share * path.duration)
        if math.hypot(ahead_x - x, ahead_y - y) > SEEN:
            return math.atan2(ahead_y - y, ahead_x - x)
        share *= 2.0
    return 0.0
