"""Finds blobs of the robot's kind: in a window pixel by pixel, in the whole picture on a coarse grid first."""

from __future__ import annotations

import math

from vision.tracking.colour import Image, RobotColours
from vision.tracking.detection import Blob, Candidate, RegionFilter, Window, find, measure
from vision.tracking.reading import BlobReader
from vision.tracking.windows import SPARE, Place, touches, window_around

COARSE_WIDTH = 2.5
"""The whole frame is searched on the coarsest grid that leaves the body this wide, in grid points."""
COARSE_AREA_TOLERANCE = 2.0
"""On that grid an area may be wrong by this factor."""
LENGTH_TOLERANCE = 1.5
"""A blob is not longer and not shorter than the robot by more than this factor: tilt, lens and blur change less."""
MOST_MERGED = 3.0
"""A blob of the coarse grid that is longer than so many bodies is no row of robots."""
HALF = 0.6
"""Half side of the window that holds a body lying any way, body lengths."""


class Seeker:
    """colours, region (px^2), elongation_min: of the robot.  length: of its body, px.  whole: the picture."""

    def __init__(
        self, colours: RobotColours, region: RegionFilter, elongation_min: float, length: float, whole: Window
    ) -> None:
        self._colours = colours
        self._reader = BlobReader(colours)
        self._region = region
        self._elongation_min = elongation_min
        self._length = length
        self._whole = whole
        self._step = self._coarsest()

    def glance(self, image: Image, window: Window) -> Blob | None:
        """The robot, if it is alone in a window and as it was at the last close look; the common case, and cheap."""
        return self._reader.glance(image, window)

    def within(self, image: Image, window: Window) -> list[Candidate]:
        """The blobs of a window, whole or cut by its edge."""
        return find(image, window, self._colours, self._region)

    def everywhere(self, image: Image) -> list[Candidate]:
        """The blobs of the whole picture; places and areas are rough."""
        coarse = self._region.scaled(1.0, COARSE_AREA_TOLERANCE)
        return find(image, self._whole, self._colours, coarse, step=self._step)

    def measured(self, image: Image, window: Window, candidate: Candidate) -> Blob | None:
        """A candidate of `within`; None when it is not of the robot's shape, or leaves the picture."""
        if touches(candidate.box, window):
            cut = touches(candidate.box, self._whole)
            return None if cut else self._at(image, candidate.centre, 0.5 * self._length)
        return self._shaped(self._reader.read(image, window, candidate))

    def beneath(self, image: Image, coarse: Candidate) -> list[tuple[Candidate, Blob | None]]:
        """What a blob of `everywhere` is when it is looked at closely: on the coarse grid two side by side are one.

        None for what has not the robot's shape.
        """
        u0, v0, u1, v1 = coarse.box
        if not max(u1 - u0, v1 - v0) <= MOST_MERGED * self._length:
            return []
        half = 0.5 * (u1 - u0) + 2.0 * self._step + SPARE, 0.5 * (v1 - v0) + 2.0 * self._step + SPARE
        window = window_around(coarse.centre, half, self._whole)
        whole = [each for each in self.within(image, window) if not touches(each.box, window)]
        return [(each, self._shaped(measure(image, window, each, self._colours))) for each in whole]

    def _at(self, image: Image, place: Place, reach: float) -> Blob | None:
        """The blob at a place that is known to `reach`, px."""
        half = HALF * self._length + reach
        window = window_around(place, (half, half), self._whole)
        whole = [each for each in self.within(image, window) if not touches(each.box, window)]
        if not whole:
            return None
        nearest = min(whole, key=lambda each: math.dist(each.centre, place))
        if not math.dist(nearest.centre, place) <= 0.5 * self._length:
            return None
        return self._shaped(measure(image, window, nearest, self._colours))

    def _shaped(self, blob: Blob) -> Blob | None:
        length = math.dist(blob.corners[1], blob.corners[2])
        is_long = self._length / LENGTH_TOLERANCE <= length <= self._length * LENGTH_TOLERANCE
        return blob if is_long and blob.elongation >= self._elongation_min else None

    def _coarsest(self) -> int:
        width = self._region.middle / self._length
        return next((step for step in (8, 4, 2) if width / step >= COARSE_WIDTH), 1)
