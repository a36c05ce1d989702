"""Blobs of the robot's colour in one picture, with centre and axis to a fraction of a pixel."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import cv2
import numpy as np
from cv2.typing import MatLike
from numpy.typing import NDArray

from vision.tracking.colour import Colour, Image, RobotColours
from vision.tracking.coverage import Masks, cover
from vision.tracking.glare import completed
from vision.tracking.shape import Ellipse

Window = tuple[int, int, int, int]
"""Part of a picture (u0, v0, u1, v1), px: u0 <= u < u1, v0 <= v < v1."""

SURROUNDINGS = 6
"""So far round its box the ground beside a blob is looked at, px: its blurred rim, and two pixels more."""
LEAST_MARK = 0.03
"""A mark covers at least this share of the robot; less is noise."""
LEAST_MARK_PLACE = 0.5
"""A mark on an end lies at least this far from the middle, in the body's radii of gyration along its axis (the end
itself is at 1.7)."""
WORD = 4
"""Bytes that are read at once."""
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


class Mask(Protocol):
    """Which pixels are of the robot's colour; `ColourRange` and `RobotColours` are such."""

    def mask(self, image: Image) -> Image: ...


@dataclass(frozen=True, slots=True)
class Candidate:
    """A blob before it is measured: outline (px of its window), area (px^2), box (px of the picture).

    company: the outlines of everything of the robot's colour in the window, of whatever size, its own included.
    """

    outline: NDArray[np.int32]
    area: float
    box: Window
    company: tuple[NDArray[np.int32], ...] = ()

    @property
    def others(self) -> tuple[NDArray[np.int32], ...]:
        """Without its own."""
        return tuple(each for each in self.company if each is not self.outline)

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
    corners: of the rectangle with the same second moments, four (u, v) px.  box: (u0, v0, u1, v1) px.
    mean_colour, ground: of the pixels it covers whole, and of what lies round it, BGR grey levels.
    end: +1 when the mark on end A lies towards the axis' direction, -1 when the other way, 0 when not told.
    """

    centre: tuple[float, float]
    axis: float
    area: float
    elongation: float
    corners: tuple[tuple[float, float], ...]
    box: Window
    mean_colour: Colour = (0.0, 0.0, 0.0)
    ground: Colour = (0.0, 0.0, 0.0)
    end: int = 0


def detect(image: Image, window: Window, colour: Mask, region: RegionFilter) -> list[Blob]:
    """The blobs of the colour and size asked for within the window, largest first, each measured."""
    return [measure(image, window, candidate) for candidate in find(image, window, colour, region)]


def find(image: Image, window: Window, colour: Mask, region: RegionFilter, step: int = 1) -> list[Candidate]:
    """Blobs that pass the filter, largest first; only the window is converted and looked at.

    step: looks at every n-th pixel of every n-th row; places are then good to n px.
    """
    u0, v0, u1, v1 = window
    part = image[v0:v1, u0:u1]
    if step > 1:
        part = _thinned(part, step)
    found, _ = cv2.findContours(colour.mask(part), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    outlines = tuple(np.asarray(outline, np.int32) for outline in found)
    areas = [_area(outline) * step * step for outline in outlines]
    passing = [index for index, area in enumerate(areas) if region.passes(area)]
    largest = sorted(passing, key=lambda index: -areas[index])[:MOST_BLOBS]
    return [_candidate(index, outlines, areas[index], window, step) for index in largest]


def _thinned(image: Image, step: int) -> Image:
    """Every n-th pixel of every n-th row; with a fourth channel that says nothing, where that is quicker."""
    height, width = image.shape[:2]
    if step % WORD == 0 and height % step == width % step == 0 and image.flags.c_contiguous:
        # Rows first, in one go through the memory; then a pixel with the next one's first byte, four at once.
        rows = image[::step].copy()
        image = rows.reshape(len(rows), -1, WORD)
    small = max(width // step, 1), max(height // step, 1)
    return cv2.resize(image, small, interpolation=cv2.INTER_NEAREST)


def _area(outline: MatLike) -> float:
    """Counts whole pixels, px^2; the polygon through the outline's pixel centres cuts those in half."""
    return cv2.contourArea(outline) + 0.5 * len(outline) + 1.0


def _candidate(
    index: int, outlines: tuple[NDArray[np.int32], ...], area: float, window: Window, step: int
) -> Candidate:
    outline = outlines[index]
    u, v, width, height = cv2.boundingRect(outline)
    left, top = window[0] + u * step, window[1] + v * step
    return Candidate(outline, area, (left, top, left + width * step, top + height * step), outlines)


def measure(image: Image, window: Window, candidate: Candidate, colours: RobotColours | None = None) -> Blob:
    """Centre and axis from the moments of the share of each pixel that the blob covers.

    The moments are then those of the true shape; a threshold or the rectangle's corners would round them to
    whole pixels.  colours: tells which end bears the mark, where there is one.
    """
    u0, v0, u1, v1 = widened(candidate.box, SURROUNDINGS, image)
    patch, offset = image[v0:v1, u0:u1], (window[0] - u0, window[1] - v0)
    inside = _filled([candidate.outline], patch, offset)
    company = candidate.others
    others = _filled(company, patch, offset) if company else None
    mark = None if colours is None else _mark(patch, inside, colours)
    found = cover(patch, Masks(inside, others, mark))
    moments = cv2.moments(found.share if found.hidden is None else completed(found.share, found.hidden))
    if not moments["m00"] > 0.0:
        moments = cv2.moments(inside, binaryImage=True)
    ellipse = Ellipse.of(moments)
    return Blob(
        centre=(u0 + ellipse.u, v0 + ellipse.v),
        axis=ellipse.axis,
        area=candidate.area,
        elongation=ellipse.elongation,
        corners=ellipse.corners(u0, v0),
        box=candidate.box,
        mean_colour=found.blob,
        ground=found.ground,
        end=0 if mark is None else _end(mark, ellipse),
    )


def _filled(outlines: Sequence[MatLike], patch: Image, offset: tuple[int, int]) -> MatLike:
    """255 within the outlines, holes included; offset: from the outlines' origin to the patch's, px."""
    mask = np.zeros(patch.shape[:2], np.uint8)
    return cv2.drawContours(mask, outlines, -1, 255, cv2.FILLED, cv2.LINE_8, None, 0, offset)


def _mark(patch: Image, inside: MatLike, colours: RobotColours) -> MatLike | None:
    """255 on the mark; None when too little of it is seen."""
    if colours.end_mark is None:
        return None
    mark = cv2.bitwise_and(colours.end_mark.mask(patch), inside)
    return mark if cv2.countNonZero(mark) >= LEAST_MARK * cv2.countNonZero(inside) else None


def _end(mark: MatLike, ellipse: Ellipse) -> int:
    """Towards which end of the axis the mark lies: +1 or -1; 0 when it is not at an end."""
    moments = cv2.moments(mark, binaryImage=True)
    du, dv = moments["m10"] / moments["m00"] - ellipse.u, moments["m01"] / moments["m00"] - ellipse.v
    along = du * math.cos(ellipse.axis) + dv * math.sin(ellipse.axis)
    if not abs(along) >= LEAST_MARK_PLACE * math.sqrt(max(ellipse.long, 0.0)):
        return 0
    return 1 if along > 0.0 else -1


def widened(box: Window, by: int, image: Image) -> Window:
    """The box and `by` px round it, within the picture."""
    height, width = image.shape[:2]
    u0, v0, u1, v1 = box
    return max(u0 - by, 0), max(v0 - by, 0), min(u1 + by, width), min(v1 + by, height)
