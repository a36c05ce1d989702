"""Blobs of the robot's colour in one picture, with centre and axis to a fraction of a pixel."""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np
from cv2.typing import MatLike
from numpy.typing import NDArray

from vision.tracking.colour import ColourRange, Image

Window = tuple[int, int, int, int]
"""Part of a picture (u0, v0, u1, v1), px: u0 <= u < u1, v0 <= v < v1."""

RIM = 3
"""The blurred edge of a blob reaches that far out of its mask, px (3 sigma of 0.7 px, and half a pixel)."""
LEAST_CHROMA = 20.0
"""Below this difference in colour, grey levels, brightness has to tell the blob from its surroundings."""
MOST_BLOBS = 64
"""A picture with more blobs than this, such as noise in the dark, yields the largest ones."""


@dataclass(frozen=True, slots=True)
class RegionFilter:
    """How big a blob must be: area_min <= area <= area_max, m^2 on the plate or px^2 in a picture."""

    area_min: float
    area_max: float

    def __post_init__(self) -> None:
        if not 0.0 < self.area_min < self.area_max < math.inf:
            raise ValueError(
                f"areas must go from above 0 to a higher limit, got {self.area_min}..{self.area_max}"
            )

    @property
    def middle(self) -> float:
        """The middle of the two limits by ratio."""
        return math.sqrt(self.area_min * self.area_max)

    def scaled(self, factor: float, tolerance: float = 1.0) -> RegionFilter:
        """The same in another unit of area, widened by a factor to either side."""
        return RegionFilter(self.area_min * factor / tolerance, self.area_max * factor * tolerance)

    def passes(self, area: float) -> bool:
        return self.area_min <= area <= self.area_max


@dataclass(frozen=True, slots=True)
class Candidate:
    """A blob before it is measured: outline (px of its window), area (px^2), box (px of the picture)."""

    outline: NDArray[np.int32]
    area: float
    box: Window

    @property
    def centre(self) -> tuple[float, float]:
        """Middle of the box, px: good enough to choose by."""
        u0, v0, u1, v1 = self.box
        return 0.5 * (u0 + u1 - 1), 0.5 * (v0 + v1 - 1)


@dataclass(frozen=True, slots=True)
class Blob:
    """A measured blob.

    centre: (u, v) px.  axis: direction of the long axis in the picture, rad in [0, pi), u to v.
    area: px^2, of the mask.  elongation: long over short radius of gyration.
    corners: of the oriented rectangle round the mask, four (u, v) px.  box: (u0, v0, u1, v1) px.
    """

    centre: tuple[float, float]
    axis: float
    area: float
    elongation: float
    corners: tuple[tuple[float, float], ...]
    box: Window


def detect(image: Image, window: Window, colour: ColourRange, region: RegionFilter) -> list[Blob]:
    """The blobs of the colour and size asked for within the window, largest first, each measured."""
    return [measure(image, window, candidate) for candidate in find(image, window, colour, region)]


def find(
    image: Image, window: Window, colour: ColourRange, region: RegionFilter, decimation: int = 1
) -> list[Candidate]:
    """Blobs that pass the filter, largest first; only the window is converted and looked at.

    decimation: looks at every n-th pixel of every n-th row; places are then good to n px.
    """
    u0, v0, u1, v1 = window
    part = image[v0:v1, u0:u1]
    if decimation > 1:
        small = ((u1 - u0) // decimation, (v1 - v0) // decimation)
        part = cv2.resize(part, small, interpolation=cv2.INTER_NEAREST)
    mask = colour.mask(part)
    outlines, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    candidates = [_candidate(np.asarray(outline), window, decimation) for outline in outlines]
    passing = [candidate for candidate in candidates if region.passes(candidate.area)]
    return sorted(passing, key=lambda candidate: -candidate.area)[:MOST_BLOBS]


def _candidate(outline: NDArray, window: Window, decimation: int) -> Candidate:
    """The area counts whole pixels; the polygon through the outline's pixel centres cuts those in half."""
    area = cv2.contourArea(outline) + 0.5 * len(outline) + 1.0
    u, v, width, height = cv2.boundingRect(outline)
    left, top = window[0] + u * decimation, window[1] + v * decimation
    box = (left, top, left + width * decimation, top + height * decimation)
    return Candidate(outline, area * decimation * decimation, box)


def measure(image: Image, window: Window, candidate: Candidate) -> Blob:
    """Centre and axis from the moments of how much each pixel differs from the surroundings towards the blob.

    At an edge this difference is the share of the pixel that the blob covers, so the moments are those of the
    true shape; a threshold or the rectangle's corners would round them to whole pixels.
    """
    u0, v0, u1, v1 = _widened(candidate.box, RIM + 1, image)
    local = np.add(candidate.outline, (window[0] - u0, window[1] - v0))
    inside = np.zeros((v1 - v0, u1 - u0), np.uint8)
    cv2.drawContours(inside, [local], -1, 255, cv2.FILLED)
    moments = cv2.moments(_coverage(image[v0:v1, u0:u1], inside))
    mass = moments["m00"]
    if not mass > 0.0:
        moments = cv2.moments(inside, binaryImage=True)
        mass = moments["m00"]
    long, short, axis = _ellipse(moments["mu20"] / mass, moments["mu11"] / mass, moments["mu02"] / mass)
    corners = cv2.boxPoints(cv2.minAreaRect(local))
    return Blob(
        centre=(u0 + moments["m10"] / mass, v0 + moments["m01"] / mass),
        axis=axis,
        area=candidate.area,
        elongation=math.sqrt(long / max(short, 1e-9)),
        corners=tuple((u0 + float(u), v0 + float(v)) for u, v in corners),
        box=candidate.box,
    )


def _coverage(patch: Image, inside: Image) -> MatLike:
    """How much of each pixel is the blob, float32 in units of no matter; 0 beyond the blob's blurred rim."""
    reach = cv2.dilate(inside, _RIM_SHAPE)
    blob, ground = cv2.mean(patch, inside)[:3], cv2.mean(patch, cv2.bitwise_not(reach))[:3]
    b, g, r = _towards(blob, ground)
    offset = -(b * ground[0] + g * ground[1] + r * ground[2])
    difference = cv2.transform(patch.astype(np.float32), np.array([[b, g, r, offset]], np.float32))
    return cv2.copyTo(difference, reach)


_RIM_SHAPE = np.ones((2 * RIM + 1, 2 * RIM + 1), np.uint8)


def _towards(blob: tuple[float, ...], ground: tuple[float, ...]) -> tuple[float, float, float]:
    """Direction in BGR from the surroundings to the blob, unit length.

    Without its grey part where the colours allow it, so that a shadow on a grey plate weighs nothing.
    """
    b, g, r = (one - other for one, other in zip(blob, ground, strict=True))
    grey = (b + g + r) / 3.0
    chroma = math.hypot(b - grey, g - grey, r - grey)
    if chroma >= LEAST_CHROMA:
        return (b - grey) / chroma, (g - grey) / chroma, (r - grey) / chroma
    length = max(math.hypot(b, g, r), 1e-9)
    return b / length, g / length, r / length


def _ellipse(mu20: float, mu11: float, mu02: float) -> tuple[float, float, float]:
    """Principal second moments, long and short (px^2), and direction of the long one, rad in [0, pi)."""
    mean, spread = 0.5 * (mu20 + mu02), math.hypot(0.5 * (mu20 - mu02), mu11)
    return mean + spread, mean - spread, 0.5 * math.atan2(2.0 * mu11, mu20 - mu02) % math.pi


def _widened(box: Window, by: int, image: Image) -> Window:
    height, width = image.shape[:2]
    u0, v0, u1, v1 = box
    return max(u0 - by, 0), max(v0 - by, 0), min(u1 + by, width), min(v1 + by, height)
