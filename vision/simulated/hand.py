"""A hand that reaches into the picture, above everything else."""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from vision.simulated.figures import Region
from vision.simulated.plate import Colour, Image

SKIN: Colour = (125.0, 155.0, 205.0)
"""Fair skin in full light: a red with little saturation, the nearest to the red robot that is often there."""
EDGE = 1.5
"""Standard deviation of the hand's edge, px: it is nearer than the camera is focused, and moves."""
ARM_LENGTH = 12.0
ARM_WIDTH = 0.7
FINGER_LENGTH = 2.1
FINGER_WIDTH = 0.22
"""All relative to the palm's radius, as in anatomy."""
FINGERS = (-0.75, -0.26, -0.02, 0.22, 0.46)
"""Directions of thumb and fingers from the hand's own, rad."""
SHIFT = 4
"""Fraction bits of OpenCV's drawing coordinates."""


@dataclass(frozen=True, slots=True)
class Hand:
    """palm: (u, v) of the palm's middle, px.  direction: in which it points, rad.  radius: of the palm, px."""

    palm: tuple[float, float]
    direction: float
    radius: float

    def draw(self, image: Image, skin: Image) -> None:
        """Into a picture. skin: how skin all over the picture would look."""
        height, width = image.shape[:2]
        ends = np.array([point for bone in self._bones() for point in bone[:2]])
        region = Region.around(ends, self.radius + 3.0 * EDGE, (width, height))
        if region.is_empty:
            return
        cover = self._cover(region)
        region.of(image)[:] = cv2.blendLinear(region.of(image), region.of(skin), 1.0 - cover, cover)

    def covers(self, points: NDArray) -> NDArray:
        """Which of the points (n, 2) px lie beneath it."""
        beneath = np.zeros(len(points), bool)
        for begin, end, radius in self._bones():
            beneath |= _distance(points, np.array(begin), np.array(end)) <= radius
        return beneath

    def _bones(self) -> list[tuple[tuple[float, float], tuple[float, float], float]]:
        """Two ends (u, v) and the radius round each of forearm, palm and fingers, px."""
        back = self.direction + math.pi
        bones = [
            (self.palm, self._from_palm(back, ARM_LENGTH), ARM_WIDTH * self.radius),
            (self.palm, self.palm, self.radius),
        ]
        for spread in FINGERS:
            tip = self._from_palm(self.direction + spread, FINGER_LENGTH)
            bones.append((self.palm, tip, FINGER_WIDTH * self.radius))
        return bones

    def _from_palm(self, direction: float, radii: float) -> tuple[float, float]:
        u, v = self.palm
        return u + radii * self.radius * math.cos(direction), v + radii * self.radius * math.sin(direction)

    def _cover(self, region: Region) -> NDArray:
        """How much of each pixel of the region it covers, 0..1 float32."""
        drawn = np.zeros(region.size, np.uint8)
        for begin, end, radius in self._bones():
            ends = (np.array([begin, end]) - (region.left, region.top)) * 2**SHIFT
            first, second = (tuple(np.rint(point).astype(int).tolist()) for point in ends)
            cv2.line(drawn, first, second, 255, max(1, round(2.0 * radius)), cv2.LINE_8, SHIFT)
        return cv2.GaussianBlur(drawn, (0, 0), EDGE) * np.float32(1.0 / 255.0)


def _distance(points: NDArray, begin: NDArray, end: NDArray) -> NDArray:
    """From points (n, 2) to a straight piece, px."""
    along = end - begin
    square = float(along @ along)
    share = np.clip((points - begin) @ along / square, 0.0, 1.0) if square > 0.0 else np.zeros(len(points))
    return np.hypot(*(points - begin - share[:, None] * along).T)
