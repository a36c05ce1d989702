"""Thresholds on hue, saturation and value that keep the robot and reject its surroundings by the widest margin.

Both are also tried at other brightnesses, as far as that leaves a gap between them: light changes during a run, and
a value range of today's light alone would lose the robot when a lamp is switched on.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from vision.tracking.colour import ColourRange

Colours = NDArray[np.uint8]
"""Pixels (n, 3), BGR."""
Features = NDArray[np.float32]
"""Pixels (n, 3): hue as a distance from the robot's hue (-180..180 degrees), saturation and value (0..255)."""

LIGHT_CHANGES = (0.4, 0.25, 0.1, 0.0)
"""Changes of brightness, as a fraction either way, that are tried: as wide as the surroundings allow."""
INSIDE_SHARE = 0.02
"""Of the robot's pixels that may lie outside to either side of each channel: noise, and the last of a blurred rim."""
STRAY_SHARE = 1e-3
"""Of the surroundings' pixels that may be taken for the robot: single ones make no blob."""
SAME_SHARE = 0.02
"""With more than this of the surroundings in the robot's colours, there is no telling them apart."""
LEAST_COLOUR = 12.0
"""Grey levels between the strongest and the weakest channel; below it, hue is noise and tells nothing."""
WIDEST_HUE = 40.0
"""Degrees; pixels whose hues spread further have no hue in common (a dark or a colourless robot)."""
HUE_ROOM = 20.0
"""How far beyond the robot's own hues the range may go, degrees: to the next colour name."""
SATURATION_ROOM = 60.0
VALUE_ROOM = 60.0
"""How far beyond the robot's own saturations and values the range may go."""


@dataclass(frozen=True, slots=True)
class Fit:
    """Thresholds for one robot on one background.

    light_change: the change of brightness that they bear, as a fraction either way.
    separation: how far the most similar of the surroundings is away, 0 (the same colour) to 1 (all the room there is).
    """

    colour: ColourRange
    light_change: float
    separation: float


@dataclass(frozen=True, slots=True)
class Box:
    """The robot's own range in each of the three features, and how far it may be widened to either side."""

    low: NDArray[np.float32]
    high: NDArray[np.float32]
    room_below: NDArray[np.float32]
    room_above: NDArray[np.float32]

    def excess(self, features: Features) -> tuple[NDArray, NDArray]:
        """How far below and above the range each feature (n, 3) is, in units of the room there."""
        below = np.maximum(self.low - features, 0.0) / self.room_below
        above = np.maximum(features - self.high, 0.0) / self.room_above
        return below, above

    def widened(self, below: NDArray, above: NDArray) -> tuple[NDArray, NDArray]:
        """The ends (3,) after taking these shares (3,) of the room."""
        return self.low - below * self.room_below, self.high + above * self.room_above


def fit(robot: Colours, ground: Colours) -> Fit | None:
    """Thresholds that tell the robot's pixels from those around it; None where both have the same colours."""
    hue = _common_hue(robot)
    now = _box(_features(robot, hue), hue is None)
    surroundings = _features(ground, hue)
    distance = _distances(now, surroundings)
    if np.count_nonzero(distance <= 0.0) > SAME_SHARE * len(distance):
        return None
    separation = min(float(np.quantile(distance, STRAY_SHARE)), 1.0)
    change, box, others = _steadiest(robot, ground, hue)
    return Fit(_range(*box.widened(*_halfway(box, others)), hue), change, separation)


def _steadiest(robot: Colours, ground: Colours, hue: float | None) -> tuple[float, Box, Features]:
    """The widest change of brightness that leaves a gap, with the robot's range and the surroundings over it."""
    change, box, others = 0.0, _box(_features(robot, hue), hue is None), _features(ground, hue)
    for wider in reversed(LIGHT_CHANGES):
        wider_box = _box(_features(_in_other_light(robot, wider), hue), hue is None)
        wider_others = _features(_in_other_light(ground, wider), hue)
        if np.count_nonzero(_distances(wider_box, wider_others) <= 0.0) > STRAY_SHARE * len(wider_others):
            break
        change, box, others = wider, wider_box, wider_others
    return change, box, others


def _common_hue(robot: Colours) -> float | None:
    """The hue that the robot's pixels share, degrees; None for a colourless or a many-coloured one."""
    mean = robot.mean(axis=0)
    if not float(mean.max() - mean.min()) >= LEAST_COLOUR:
        return None
    hue = 2.0 * float(_hsv(np.rint(mean).astype(np.uint8)[None, :])[0, 0])
    spread = np.abs(_turned(2.0 * _hsv(robot)[:, 0].astype(np.float32), hue))
    return hue if float(np.quantile(spread, 1.0 - 2.0 * INSIDE_SHARE)) <= WIDEST_HUE else None


def _hsv(colours: Colours) -> NDArray[np.uint8]:
    return np.asarray(
        cv2.cvtColor(np.ascontiguousarray(colours[:, None, :]), cv2.COLOR_BGR2HSV)[:, 0], np.uint8
    )


def _turned(hue: NDArray, centre: float) -> NDArray:
    return (hue - centre + 180.0) % 360.0 - 180.0


def _features(colours: Colours, hue: float | None) -> Features:
    features = _hsv(colours).astype(np.float32)
    features[:, 0] = 0.0 if hue is None else _turned(2.0 * features[:, 0], hue)
    return features


def _in_other_light(colours: Colours, change: float) -> Colours:
    """The pixels as they are, and darker and brighter by this fraction, as the sensor would clip them."""
    if change == 0.0:
        return colours
    lights = [np.clip(np.rint(colours * light), 0.0, 255.0) for light in (1.0 - change, 1.0, 1.0 + change)]
    return np.vstack(lights).astype(np.uint8)


def _box(features: Features, is_colourless: bool) -> Box:
    low, high = np.quantile(features, [INSIDE_SHARE, 1.0 - INSIDE_SHARE], axis=0).astype(np.float32)
    room = np.array([HUE_ROOM, SATURATION_ROOM, VALUE_ROOM], np.float32)
    # A colour stays itself down to half its saturation and value; a colourless robot has none to lose.
    below = np.minimum(room, np.maximum(0.5 * low, 1.0)) if not is_colourless else room.copy()
    below[0] = room[0]
    return Box(low, high, below, room)


def _distances(box: Box, features: Features) -> NDArray:
    """Of each pixel from the box, in units of the room there, by the channel that tells it best."""
    below, above = box.excess(features)
    return np.maximum(below, above).max(axis=1)


def _halfway(box: Box, others: Features) -> tuple[NDArray, NDArray]:
    """Which share (3,) of the room below and above to take: all, or half the way to what is not the robot.

    Each pixel of the surroundings is kept out by the one channel in which it is farthest off, so that the others
    need not shrink for it.
    """
    excess = np.hstack(box.excess(others))
    nearest = excess[np.arange(len(excess)), excess.argmax(axis=1)]
    share = np.ones(6)
    for side in range(6):
        held = np.sort(nearest[(excess.argmax(axis=1) == side) & (nearest > 0.0)])
        strays = int(STRAY_SHARE * len(others))
        if len(held) > strays and held[strays] < 2.0:
            share[side] = 0.5 * held[strays]
    return np.minimum(share[:3], 1.0), np.minimum(share[3:], 1.0)


def _range(low: NDArray, high: NDArray, hue: float | None) -> ColourRange:
    saturation, value = (
        (max(math.floor(low[channel]), 0), min(math.ceil(high[channel]), 255)) for channel in (1, 2)
    )
    if hue is None:
        return ColourRange((0.0, 360.0), saturation, value)
    ends = (hue + math.floor(low[0])) % 360.0, (hue + math.ceil(high[0])) % 360.0
    return ColourRange(ends, saturation, value)
