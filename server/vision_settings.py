"""The rig file's [vision] as the tracker and the colour picker have it, in SI, and back."""

from __future__ import annotations

import math

from server.vision_section import ColourSection, VisionSection
from vision.tracking.colour import ColourRange
from vision.tracking.detection import RegionFilter
from vision.tracking.tracker import TrackerSettings


def colour_range(section: ColourSection) -> ColourRange:
    return ColourRange(section.hue_deg, section.saturation, section.value)


def colour_section(colour: ColourRange) -> ColourSection:
    """The same in the rig file's numbers, rounded outwards."""
    (low_s, high_s), (low_v, high_v) = colour.saturation, colour.value
    return ColourSection(
        hue_deg=colour.hue,
        saturation=(math.floor(low_s), math.ceil(high_s)),
        value=(math.floor(low_v), math.ceil(high_v)),
    )


def tracker_settings(vision: VisionSection) -> TrackerSettings:
    """What the tracker is told of the robot's looks, in SI."""
    in_use = vision.in_use
    return TrackerSettings(
        colour=colour_range(in_use),
        region=RegionFilter(vision.area_mm2[0] * 1e-6, vision.area_mm2[1] * 1e-6),
        heading_hint=math.radians(vision.heading_hint_deg),
        end_mark=None if in_use.end_mark is None else colour_range(in_use.end_mark),
        heading_offset=math.radians(vision.heading_offset_deg),
    )
