"""The robot's colour: thresholds on hue, saturation and value."""

from __future__ import annotations

from dataclasses import dataclass, field

import cv2
import numpy as np
from cv2.typing import MatLike

Image = MatLike
"""A picture (height, width) or (height, width, 3), uint8."""

Colour = tuple[float, float, float]
"""Blue, green, red; grey levels."""

HUE_STEPS = 180
"""OpenCV counts hue in steps of 2 degrees, 0..179."""
RED_FOR_BLUE = 120
"""Hue of a picture's pure red when its red and blue are exchanged."""


class ColourError(ValueError):
    """A colour range that cannot be used; the text says what came and what is allowed."""


Span = tuple[float, float]
"""Low and high end, both included."""
Levels = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class _Box:
    """Hue (in steps), saturation and value from `low` to `high`, after a conversion to HSV; the fourth is OpenCV's."""

    conversion: int
    low: Levels
    high: Levels


@dataclass(frozen=True, slots=True)
class ColourRange:
    """Thresholds on colour.

    hue: on the colour circle (0 red, 120 green, 240 blue), 0..360 degrees; a low end above the high end means
    the way through red.  saturation, value: 0..255.
    """

    hue: Span
    saturation: Span = (0, 255)
    value: Span = (0, 255)
    _boxes: tuple[_Box, ...] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        for name, span, most in (
            ("hue", self.hue, 360),
            ("saturation", self.saturation, 255),
            ("value", self.value, 255),
        ):
            if not all(0 <= end <= most for end in span):
                raise ColourError(f"{name} must be within 0..{most}, got {span[0]}..{span[1]}")
            if name != "hue" and not span[0] <= span[1]:
                raise ColourError(f"{name} must go from low to high, got {span[0]}..{span[1]}")
        object.__setattr__(self, "_boxes", self._in_steps())

    def mask(self, image: Image) -> Image:
        """255 where a BGR picture is within the range, else 0."""
        first, *rest = self._boxes
        converted = cv2.cvtColor(image, first.conversion)
        mask = cv2.inRange(converted, first.low, first.high)
        for box in rest:
            cv2.bitwise_or(mask, cv2.inRange(converted, box.low, box.high), dst=mask)
        return mask

    def _in_steps(self) -> tuple[_Box, ...]:
        """The range in OpenCV's steps: one piece of the colour circle, or two of them with the same conversion."""
        low, high = (min(round(end * HUE_STEPS / 360.0), HUE_STEPS - 1) for end in self.hue)
        if low <= high:
            if self.hue[0] > self.hue[1]:  # through red, and all the way round: the gap is less than a step
                low, high = 0, HUE_STEPS - 1
            return (self._box(cv2.COLOR_BGR2HSV, low, high),)
        if low > RED_FOR_BLUE >= high:
            # With red and blue exchanged the hue h becomes 120 - h, and a range through red has no gap.
            return (self._box(cv2.COLOR_RGB2HSV, RED_FOR_BLUE - high, RED_FOR_BLUE + HUE_STEPS - low),)
        return (
            self._box(cv2.COLOR_BGR2HSV, 0, high),
            self._box(cv2.COLOR_BGR2HSV, low, HUE_STEPS - 1),
        )

    def _box(self, conversion: int, hue_low: int, hue_high: int) -> _Box:
        low = (hue_low, self.saturation[0], self.value[0], 0)
        return _Box(conversion, low, (hue_high, self.saturation[1], self.value[1], 0))


SEAM = 2
"""Body and mark blur into each other over so many pixels on either side."""
_SEAM_SHAPE = np.ones((2 * SEAM + 1, 2 * SEAM + 1), np.uint8)


@dataclass(frozen=True, slots=True)
class RobotColours:
    """What belongs to the robot: its body's colour, and that of a mark on its end A if there is one."""

    body: ColourRange
    end_mark: ColourRange | None = None

    def mask(self, image: Image) -> Image:
        """255 where a BGR picture shows body or mark, or the seam between them, where the two colours mix; else 0."""
        body = self.body.mask(image)
        if self.end_mark is None:
            return body
        mark = self.end_mark.mask(image)
        seam = cv2.bitwise_and(cv2.dilate(body, _SEAM_SHAPE), cv2.dilate(mark, _SEAM_SHAPE))
        return cv2.bitwise_or(cv2.bitwise_or(body, mark), seam)
