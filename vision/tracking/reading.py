"""Measures the robot that is followed: at a glance while nothing has changed, closely otherwise."""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np
from cv2.typing import MatLike

from vision.tracking.colour import Colour, Image, RobotColours
from vision.tracking.coverage import DARK_EDGE, LIT_EDGE, Contrast
from vision.tracking.detection import Blob, Candidate, Window, measure
from vision.tracking.shape import Ellipse

COLOURED_EDGE = 0.1, 0.9
"""At a glance the share of a pixel counts as 0 below and as 1 above: noise of a few hundredths vanishes."""
GLANCES = 12
"""After so many a close look is taken, 5 times a second: light and colours drift."""
SAME_SHAPE = 0.015
"""Mass and sides that differ by less than this share from those of the last close look are the same: of a robot
37 px long, 0.3 px in its place at the very most (they scatter by 0.004 with the sensor's noise)."""
SAME_COLOUR = 6.0
"""and so are mean colours in which each of blue, green and red differs by less than this, grey levels."""
SAME_PLACE = 0.1
"""A glance is trusted where it agrees with a close look at the same picture to this, px,"""
SAME_AXIS = math.radians(1.0)
"""and to this, rad."""


@dataclass(frozen=True, slots=True)
class Glance:
    """What a window shows in the robot's colour. mass: of the shares, 1/255 px^2.  colour: mean, BGR grey levels."""

    mass: float
    colour: Colour
    ellipse: Ellipse

    def agrees(self, other: Glance) -> bool:
        """Whether it is the same shape of the same colour in the same light, and nothing else in the window."""
        mine, its = self.ellipse, other.ellipse
        return (
            abs(self.mass - other.mass) <= SAME_SHAPE * other.mass
            and abs(mine.long - its.long) <= 2.0 * SAME_SHAPE * its.long
            and abs(mine.short - its.short) <= 2.0 * SAME_SHAPE * its.short
            and self._is_of_the_colour(other.colour)
        )

    def _is_of_the_colour(self, colour: Colour) -> bool:
        (blue, green, red), (its_blue, its_green, its_red) = self.colour, colour
        return (
            abs(blue - its_blue) <= SAME_COLOUR
            and abs(green - its_green) <= SAME_COLOUR
            and abs(red - its_red) <= SAME_COLOUR
        )


@dataclass(frozen=True, slots=True)
class Acquaintance:
    """A robot that was looked at closely. row: (1, 4) float32, blue, green, red and 1 to 255 times the share."""

    row: MatLike
    glance: Glance
    blob: Blob


class BlobReader:
    """Remembers the colours of the robot and its ground from one close look to the next."""

    def __init__(self, colours: RobotColours) -> None:
        self._colours = colours
        self._known: Acquaintance | None = None
        self._left = 0

    def glance(self, image: Image, window: Window) -> Blob | None:
        """The robot if it is in the window, alone, and as it was when it was last looked at closely."""
        if self._known is None or self._left <= 0:
            return None
        seen = _seen(image, window, self._known.row)
        if seen is None or not seen.agrees(self._known.glance):
            return None
        self._left -= 1
        return _as_before(self._known.blob, seen.ellipse, window)

    def read(self, image: Image, window: Window, candidate: Candidate) -> Blob:
        """A candidate, measured closely."""
        blob = measure(image, window, candidate, self._colours)
        row = _row_of(blob)
        seen = _seen(image, window, row)
        is_told = seen is not None and _is_there(seen.ellipse, window, blob)
        self._known = Acquaintance(row, seen, blob) if seen is not None and is_told else None
        self._left = GLANCES
        return blob


def _row_of(blob: Blob) -> MatLike:
    contrast = Contrast.between(blob.mean_colour, blob.ground)
    low, high = COLOURED_EDGE if contrast.is_coloured else (DARK_EDGE, LIT_EDGE)
    scale = 255.0 / (high - low)
    blue, green, red, offset = contrast.row[0].tolist()
    return np.array([[scale * blue, scale * green, scale * red, scale * (offset - low)]], np.float32)


def _seen(image: Image, window: Window, row: MatLike) -> Glance | None:
    u0, v0, u1, v1 = window
    part = image[v0:v1, u0:u1]
    shares = cv2.transform(part, row)
    moments = cv2.moments(shares)
    if not moments["m00"] > 0.0:
        return None
    blue, green, red, _ = cv2.mean(part, shares)
    return Glance(moments["m00"], (blue, green, red), Ellipse.of(moments))


def _is_there(ellipse: Ellipse, window: Window, blob: Blob) -> bool:
    turn = (ellipse.axis - blob.axis + 0.5 * math.pi) % math.pi - 0.5 * math.pi
    apart = math.dist((window[0] + ellipse.u, window[1] + ellipse.v), blob.centre)
    return apart <= SAME_PLACE and abs(turn) <= SAME_AXIS


def _as_before(last: Blob, ellipse: Ellipse, window: Window) -> Blob:
    """The robot of the last close look, where it is now."""
    u, v = window[0] + ellipse.u, window[1] + ellipse.v
    corners = ellipse.corners(window[0], window[1])
    (u0, v0), (u1, v1) = corners[:2]  # the other two lie opposite
    half_u, half_v = max(abs(u0 - u), abs(u1 - u)), max(abs(v0 - v), abs(v1 - v))
    box = (
        math.floor(u - half_u),
        math.floor(v - half_v),
        math.ceil(u + half_u) + 1,
        math.ceil(v + half_v) + 1,
    )
    # In the order of its fields: naming all of them takes as long as working them out.
    return Blob(
        (u, v),
        ellipse.axis,
        last.area,
        ellipse.elongation,
        corners,
        box,
        last.mean_colour,
        last.ground,
        last.end,
    )
