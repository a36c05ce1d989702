"""Draws the robot and its like: top surface, a mark on end A, the shadow, and motion during the exposure."""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np
from cv2.typing import MatLike
from numpy.typing import NDArray

from control.model import PIVOT_A, Body, opposite, pivot_point
from vision.camera_model import CameraModel
from vision.simulated.plate import Colour, Image

Corner = tuple[float, float, float]

SHADOW_SOFTNESS = 2.0
"""Standard deviation of the shadow's edge, px."""
MARK_SHARE = 0.25
"""How much of the body's length the coloured mark on end A takes."""


@dataclass(frozen=True, slots=True)
class Look:
    """A body's length, width and height of its top surface, m; its colour, and that of the mark on its end A."""

    length: float
    width: float
    height: float
    colour: Colour
    end_mark: Colour | None = None


@dataclass(frozen=True, slots=True)
class Shadow:
    """Of a body on the plate. strength: 0 (none) to 1 (black).  offset: from the body, m."""

    strength: float
    offset: tuple[float, float]


@dataclass(frozen=True, slots=True)
class Figure:
    """One body in one picture. bodies: at even times over the exposure, the middle one at mid-exposure."""

    bodies: tuple[Body, ...]
    look: Look

    @property
    def body(self) -> Body:
        """At mid-exposure."""
        return self.bodies[len(self.bodies) // 2]


@dataclass(frozen=True, slots=True)
class Region:
    """A rectangle of the picture, px: left <= u < right, top <= v < bottom."""

    left: int
    top: int
    right: int
    bottom: int

    @classmethod
    def around(cls, points: NDArray, margin: float, size: tuple[int, int]) -> Region:
        """Around points (n, 2) px with a margin, px, within a picture of this size."""
        (u0, v0), (u1, v1) = points.min(axis=0).tolist(), points.max(axis=0).tolist()
        width, height = size
        return cls(
            max(math.floor(u0 - margin), 0),
            max(math.floor(v0 - margin), 0),
            min(math.ceil(u1 + margin), width),
            min(math.ceil(v1 + margin), height),
        )

    @property
    def size(self) -> tuple[int, int]:
        """(height, width), px."""
        return self.bottom - self.top, self.right - self.left

    @property
    def is_empty(self) -> bool:
        return self.right <= self.left or self.bottom <= self.top

    def of(self, image: MatLike) -> MatLike:
        """That part of a picture (height, width, channels) px, as a view."""
        return image[self.top : self.bottom, self.left : self.right]


class FigurePainter:
    """Draws figures into pictures of one camera.

    light: over the picture (height, width).  dark: taken from every grey level.  blur: of the lens, px.
    """

    def __init__(self, optics: CameraModel, light: NDArray, dark: float, blur: float) -> None:
        self._optics = optics
        self._light = light
        self._dark = dark
        self._blur = blur
        self._places = _places(optics.size)

    def draw(self, image: Image, figure: Figure, shadow: Shadow) -> Region:
        """Draws a figure and its shadow into the picture; returns what it has changed."""
        outlines = [self.outline(body, figure.look) for body in figure.bodies]
        cast = self._cast(figure, shadow)
        margin = 3.0 * max(self._blur, SHADOW_SOFTNESS) + 1.0
        region = Region.around(np.concatenate([*outlines, cast]), margin, self._optics.size)
        if region.is_empty:
            return region
        places = region.of(self._places).transpose(2, 0, 1)
        patch = _shade(region.of(image), _soft_coverage(cast, region), shadow.strength)
        coverage = self._blurred(_mean([coverage_of(corners, places) for corners in outlines]))
        middle = outlines[len(outlines) // 2]
        colour = self._flat(patch, figure.look.colour, middle)
        if figure.look.end_mark is not None:
            mark = self._flat(patch, figure.look.end_mark, middle)
            share = self._blurred(
                _mean(
                    [
                        _mark_share(c, b.pivot == PIVOT_A, places)
                        for c, b in zip(outlines, figure.bodies, strict=True)
                    ]
                )
            )
            colour = cv2.blendLinear(colour, mark, 1.0 - share, share)
        region.of(image)[:] = cv2.blendLinear(patch, colour, 1.0 - coverage, coverage)
        return region

    def outline(self, body: Body, look: Look) -> NDArray:
        """Corners (4, 2) px of a body's top surface; the first two are those of the pressed end."""
        to_pixel = self._optics.to_pixel
        return np.array(
            [to_pixel(x, y, z) for x, y, z in top_surface(body, look.length, look.width, look.height)]
        )

    def _cast(self, figure: Figure, shadow: Shadow) -> NDArray:
        """Corners (4, 2) px of the shadow on the plate at mid-exposure."""
        look, (dx, dy) = figure.look, shadow.offset
        top = top_surface(figure.body, look.length, look.width, look.height)
        return np.array([self._optics.to_pixel(x + dx, y + dy) for x, y, _ in top])

    def _flat(self, like: Image, colour: Colour, corners: NDArray) -> Image:
        """One colour all over, in the light at the middle of the corners."""
        width, height = self._optics.size
        u, v = (sum(coordinate) / 4.0 for coordinate in zip(*corners.tolist(), strict=True))
        light = self._light[min(max(round(v), 0), height - 1), min(max(round(u), 0), width - 1)]
        flat = [round(min(max(value * float(light) - self._dark, 0.0), 255.0)) for value in colour]
        filled = np.empty_like(like)
        cv2.rectangle(filled, (0, 0), filled.shape[1::-1], flat, cv2.FILLED)
        return filled

    def _blurred(self, coverage: NDArray) -> MatLike:
        return cv2.GaussianBlur(coverage, (0, 0), self._blur) if self._blur > 0.0 else coverage


def top_surface(
    body: Body, length: float, width: float, height: float
) -> tuple[Corner, Corner, Corner, Corner]:
    """The four corners (x, y, z) m of the body's top surface, in order round it.

    The pressed end stays where it is (assumed: its upper edge does, too); the other is raised by the tilt.
    """
    px, py = pivot_point(body.pose, body.pivot, length)
    qx, qy = pivot_point(body.pose, opposite(body.pivot), length)
    short, lift = math.cos(body.tilt), length * math.sin(body.tilt)
    qx, qy = px + (qx - px) * short, py + (qy - py) * short
    sx, sy = 0.5 * width * math.cos(body.pose.heading), 0.5 * width * math.sin(body.pose.heading)
    raised = height + lift
    return (
        (px - sx, py - sy, height),
        (px + sx, py + sy, height),
        (qx + sx, qy + sy, raised),
        (qx - sx, qy - sy, raised),
    )


def coverage_of(corners: NDArray, places: NDArray) -> NDArray:
    """How much of each pixel a convex polygon (n, 2) px covers, 0..1 float32.

    places: (3, height, width) float32, u, v and 1 of each pixel.  From each pixel's distance to the nearest
    edge, which is exact to 0.01 px for the centre and the axis (an OpenCV polygon would have to be drawn 8
    times finer for that).
    """
    distances = _edges(corners) @ places.reshape(3, -1)
    return _within_half(distances.min(axis=0).reshape(places.shape[1:]))


def _within_half(distance: NDArray) -> NDArray:
    """Share of a pixel on the inner side of an edge that is so far (px) outside its middle, in place."""
    distance += np.float32(0.5)
    np.maximum(distance, 0.0, out=distance)
    np.minimum(distance, 1.0, out=distance)
    return distance


def _mark_share(corners: NDArray, a_first: bool, places: NDArray) -> NDArray:
    """How much of each pixel lies beyond the line between body and mark, towards end A, 0..1 float32."""
    near, far = (corners[:2], corners[2:]) if a_first else (corners[2:], corners[:2])
    end, other = near.mean(axis=0), far.mean(axis=0)
    along = (end - other) / math.hypot(*(end - other))
    line = end + MARK_SHARE * (other - end)
    row = np.array([*along, -float(along @ line)], np.float32)
    return _within_half((row @ places.reshape(3, -1)).reshape(places.shape[1:]))


def _mean(shares: list[NDArray]) -> NDArray:
    return shares[0] if len(shares) == 1 else np.asarray(np.mean(shares, axis=0, dtype=np.float32))


def _shade(background: Image, coverage: MatLike, strength: float) -> Image:
    """The plate under the shadow; `coverage` is 0..1 over the region."""
    shade = coverage * np.float32(strength)
    return cv2.blendLinear(background, np.zeros_like(background), 1.0 - shade, shade)


def _places(size: tuple[int, int]) -> NDArray:
    """(height, width, 3) float32: u, v and 1 of each pixel."""
    width, height = size
    v, u = np.indices((height, width), dtype=np.float32)
    return np.dstack([u, v, np.ones_like(u)])


def _soft_coverage(corners: NDArray, region: Region) -> MatLike:
    """The same for the shadow, whose soft edge does not ask for sub-pixel places."""
    drawn = np.zeros(region.size, np.float32)
    cv2.fillConvexPoly(drawn, np.rint(corners - (region.left, region.top)).astype(np.int32), 1.0)
    return cv2.GaussianBlur(drawn, (0, 0), SHADOW_SOFTNESS)


def _edges(corners: NDArray) -> NDArray:
    """Rows (nu, nv, offset), float32: distance inwards from each edge of a convex polygon, px."""
    points = corners.tolist()
    middle_u = sum(u for u, _ in points) / len(points)
    middle_v = sum(v for _, v in points) / len(points)
    rows = []
    for (u0, v0), (u1, v1) in zip(points, points[1:] + points[:1], strict=True):
        nu, nv = v0 - v1, u1 - u0
        offset = -(nu * u0 + nv * v0)
        scale = math.copysign(1.0 / math.hypot(nu, nv), nu * middle_u + nv * middle_v + offset)
        rows.append((scale * nu, scale * nv, scale * offset))
    return np.array(rows, np.float32)
