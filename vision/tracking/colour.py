"""The robot's colour: thresholds on hue, saturation and value."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
from cv2.typing import MatLike

Image = MatLike
"""A picture (height, width) or (height, width, 3), uint8."""

HUE_STEPS = 180
"""OpenCV counts hue in steps of 2 degrees, 0..179."""
RED_FOR_BLUE = 120
"""Hue of a picture's pure red when its red and blue are exchanged."""


class ColourError(ValueError):
    """A colour range that cannot be used; the text says what came and what is allowed."""


Span = tuple[float, float]
"""Low and high end, both included."""


@dataclass(frozen=True, slots=True)
class ColourRange:
    """Thresholds on colour.

    hue: on the colour circle (0 red, 120 green, 240 blue), 0..360 degrees; a low end above the high end means
    the way through red.  saturation, value: 0..255.
    """

    hue: Span
    saturation: Span = (0, 255)
    value: Span = (0, 255)

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

    def mask(self, image: Image) -> Image:
        """255 where a BGR picture is within the range, else 0."""
        low, high = (min(round(end * HUE_STEPS / 360.0), HUE_STEPS - 1) for end in self.hue)
        if low <= high:
            if self.hue[0] > self.hue[1]:  # through red, and all the way round: the gap is less than a step
                low, high = 0, HUE_STEPS - 1
            return self._between(cv2.cvtColor(image, cv2.COLOR_BGR2HSV), low, high)
        if low > RED_FOR_BLUE >= high:
            # With red and blue exchanged the hue h becomes 120 - h, and a range through red has no gap.
            exchanged = cv2.cvtColor(image, cv2.COLOR_RGB2HSV)
            return self._between(exchanged, RED_FOR_BLUE - high, RED_FOR_BLUE + HUE_STEPS - low)
        hsv = cv2.cvtColor(image, cv2.COLOR_BGR2HSV)
        mask = self._between(hsv, 0, high)
        return cv2.bitwise_or(mask, self._between(hsv, low, HUE_STEPS - 1), dst=mask)

    def _between(self, hsv: Image, hue_low: int, hue_high: int) -> Image:
        low = (hue_low, self.saturation[0], self.value[0], 0)
        high = (hue_high, self.saturation[1], self.value[1], 0)
        return cv2.inRange(hsv, low, high)
