"""What the tracker is told of the robot."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from vision.tracking.colour import ColourRange, RobotColours
from vision.tracking.detection import RegionFilter

RED = ColourRange(hue=(340, 20), saturation=(110, 255), value=(60, 255))
"""The shipped robot's colour: red in any light that leaves it a third of full brightness."""


@dataclass(frozen=True, slots=True)
class TrackerSettings:
    """What the robot looks like and how patient the tracker is.

    colour: thresholds.  region: area of the body seen from above, m^2.
    elongation_min: long over short radius of gyration; a rounder blob has no axis to speak of.
    margin: how far beyond the expected uncertainty the robot may be, m.
    heading_hint: which of two opposite headings to take when nothing else tells, rad.
    predict_for: how long after the last sighting the robot counts as predicted, s (faults.md: 150 ms).
    end_mark: the colour of the mark on end A, if it bears one.
    heading_offset: from the heading that the body shows to that of its pivots, rad.
    """

    colour: ColourRange = field(default=RED)
    region: RegionFilter = field(default=RegionFilter(12e-6, 90e-6))
    elongation_min: float = 1.4
    margin: float = 0.001
    heading_hint: float = 0.5 * math.pi
    predict_for: float = 0.150
    end_mark: ColourRange | None = None
    heading_offset: float = 0.0

    @property
    def colours(self) -> RobotColours:
        return RobotColours(self.colour, self.end_mark)
