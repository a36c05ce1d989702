"""Draws the simulated camera's picture: plate, light, the robot with its shadow, blur and sensor noise.

The background is drawn once. A frame then costs one small patch around the robot, and one saturating
addition of sensor noise over every pixel.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np
from cv2.typing import MatLike
from numpy.typing import NDArray

from control.model import Body, opposite, pivot_point
from vision.camera_model import CameraModel

Image = MatLike
"""A picture (height, width, 3), uint8, BGR."""
Corner = tuple[float, float, float]

PLATE = (168.0, 172.0, 170.0)
"""Colour of the plate in full light, BGR grey levels (a matt white plate, exposed to two thirds)."""
INK = 0.93
"""Brightness of the printed lines relative to the plate: faint, as a light grey print is."""
GRID_STEP = 0.010
GRID_HALF_SPAN = 0.060
"""The printed grid: every 10 mm over the 120 mm workspace, m."""
VIGNETTING = 0.12
"""Loss of light in the picture's corners, as a fraction (assumed; an ordinary lens at half aperture)."""
TEXTURE_SIGMA = 1.5
"""Mottle of the plate, grey levels."""
NOISE_SPARE = 256
"""The noise tile is that much larger than the picture, px, so that no two nearby frames share their noise."""
SHADOW_SOFTNESS = 2.0
"""Standard deviation of the shadow's edge, px."""


@dataclass(frozen=True, slots=True)
class SceneSettings:
    """What the simulated camera sees, and how well.

    rate: frames/s.  latency: mid-exposure to delivery, s.
    noise, blur: standard deviations of the sensor's noise, grey levels, and of the lens blur, px.
    light_gradient: change of light across the picture's width, as a fraction.
    shadow_strength: 0 (none) to 1 (black).  shadow_offset: from the body, on the plate, m.
    length, width, height: of the robot's body, m; the height is that of its top surface.
    colour: of the body, BGR grey levels.
    """

    rate: float = 60.0
    latency: float = 0.035
    noise: float = 3.0
    blur: float = 0.7
    light_gradient: float = 0.15
    shadow_strength: float = 0.35
    shadow_offset: tuple[float, float] = (0.0012, -0.0010)
    seed: int = 0
    length: float = 0.010
    width: float = 0.004
    height: float = 0.003
    colour: tuple[float, float, float] = (40.0, 40.0, 200.0)


@dataclass(frozen=True, slots=True)
class Region:
    """A rectangle of the picture, px: left <= u < right, top <= v < bottom."""

    left: int
    top: int
    right: int
    bottom: int

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


class Painter:
    """Draws frames; equal settings and frame numbers give equal bytes."""

    def __init__(self, optics: CameraModel, scene: SceneSettings) -> None:
        self._optics = optics
        self._scene = scene
        random = np.random.default_rng(scene.seed)
        self._light = _light(optics.size, scene.light_gradient)
        self._noise, dark = _noise_tile(optics.size, scene.noise, random)
        self._dark = dark
        self._background = _background(optics, self._light, random, scene.blur, dark)
        self._places = _places(optics.size)
        self._offsets = random.integers(0, NOISE_SPARE, size=(4096, 2)).tolist()

    def paint(self, body: Body | None, index: int) -> NDArray[np.uint8]:
        """The picture with frame number `index`; without a body, the empty plate."""
        width, height = self._optics.size
        left, top = self._offsets[index % len(self._offsets)]
        noise = self._noise[top : top + height, left : left + width]
        image = cv2.add(self._background, noise)
        if body is not None:
            self._place(body, image, noise)
        image.flags.writeable = False
        return np.asarray(image, np.uint8)

    def _place(self, body: Body, image: Image, noise: Image) -> None:
        corners, shadow = self._outlines(body)
        region = self._region(corners.tolist() + shadow.tolist())
        if region.is_empty:
            return
        patch = self._shade(region.of(self._background), _soft_coverage(shadow, region))
        patch = self._colour(
            patch, _coverage(corners, region.of(self._places).transpose(2, 0, 1), self._scene.blur), corners
        )
        region.of(image)[:] = cv2.add(patch, region.of(noise))

    def _outlines(self, body: Body) -> tuple[NDArray, NDArray]:
        """Corners (4, 2) px of the body's top surface, and of its shadow on the plate."""
        top = top_surface(body, self._scene.length, self._scene.width, self._scene.height)
        dx, dy = self._scene.shadow_offset
        to_pixel = self._optics.to_pixel
        return (
            np.array([to_pixel(x, y, z) for x, y, z in top]),
            np.array([to_pixel(x + dx, y + dy) for x, y, _ in top]),
        )

    def _region(self, points: list[list[float]]) -> Region:
        """Around all the points (px) and as far as their blur reaches, within the picture."""
        margin = 3.0 * max(self._scene.blur, SHADOW_SOFTNESS) + 1.0
        width, height = self._optics.size
        us, vs = zip(*points, strict=True)
        return Region(
            max(math.floor(min(us) - margin), 0),
            max(math.floor(min(vs) - margin), 0),
            min(math.ceil(max(us) + margin), width),
            min(math.ceil(max(vs) + margin), height),
        )

    def _shade(self, background: Image, coverage: MatLike) -> Image:
        """The plate under the shadow; `coverage` is 0..1 over the region."""
        shade = coverage * np.float32(self._scene.shadow_strength)
        return cv2.blendLinear(background, np.zeros_like(background), 1.0 - shade, shade)

    def _colour(self, background: Image, coverage: MatLike, corners: NDArray) -> Image:
        width, height = self._optics.size
        u, v = (sum(coordinate) / 4.0 for coordinate in zip(*corners.tolist(), strict=True))
        light = self._light[min(max(round(v), 0), height - 1), min(max(round(u), 0), width - 1)]
        flat = [
            round(min(max(value * float(light) - self._dark, 0.0), 255.0)) for value in self._scene.colour
        ]
        body = np.empty_like(background)
        cv2.rectangle(body, (0, 0), body.shape[1::-1], flat, cv2.FILLED)
        return cv2.blendLinear(background, body, 1.0 - coverage, coverage)


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


def _coverage(corners: NDArray, places: NDArray, blur: float) -> MatLike:
    """How much of each pixel a convex polygon (n, 2) px covers, 0..1 float32, blurred by `blur` px.

    places: (3, height, width) float32, u, v and 1 of each pixel.  From each pixel's distance to the nearest
    edge, which is exact to 0.01 px for the centre and the axis (an OpenCV polygon would have to be drawn 8
    times finer for that).
    """
    distances = _edges(corners) @ places.reshape(3, -1)
    inside = distances.min(axis=0).reshape(places.shape[1:])
    inside += np.float32(0.5)
    np.maximum(inside, 0.0, out=inside)
    np.minimum(inside, 1.0, out=inside)
    return cv2.GaussianBlur(inside, (0, 0), blur) if blur > 0.0 else inside


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


def _light(size: tuple[int, int], gradient: float) -> NDArray:
    """Light over the picture (height, width): a slope along u and half of it along v, and vignetting."""
    width, height = size
    u = np.linspace(-0.5, 0.5, width, dtype=np.float32)[None, :]
    v = np.linspace(-0.5, 0.5, height, dtype=np.float32)[:, None]
    return (1.0 + gradient * (u + 0.5 * v)) * (1.0 - VIGNETTING * 2.0 * (u * u + v * v))


def _noise_tile(size: tuple[int, int], sigma: float, random: np.random.Generator) -> tuple[Image, float]:
    """Sensor noise as unsigned levels round a mean, and that mean: the background is darkened by it."""
    width, height = size
    mean = float(math.ceil(4.0 * sigma))
    tile = random.standard_normal((height + NOISE_SPARE, width + NOISE_SPARE, 3), dtype=np.float32)
    return np.clip(np.rint(tile * sigma + mean), 0.0, 255.0).astype(np.uint8), mean


def _background(
    optics: CameraModel, light: NDArray, random: np.random.Generator, blur: float, dark: float
) -> Image:
    """The empty plate as the lens sees it, without noise, darkened by `dark` grey levels."""
    mottle = cv2.GaussianBlur(random.standard_normal(light.shape, dtype=np.float32), (0, 0), 2.0)
    mottle *= TEXTURE_SIGMA / float(mottle.std())
    plate = np.array(PLATE, np.float32) * (light * _print(optics))[:, :, None] + mottle[:, :, None]
    if blur > 0.0:
        plate = cv2.GaussianBlur(plate, (0, 0), blur)
    return np.clip(np.rint(plate - dark), 0.0, 255.0).astype(np.uint8)


def _print(optics: CameraModel) -> NDArray:
    """The grid printed on the plate, as a factor on its brightness (height, width)."""
    width, height = optics.size
    sheet = np.zeros((height, width), np.uint8)
    along = np.linspace(-GRID_HALF_SPAN, GRID_HALF_SPAN, 61)
    for place in np.arange(-GRID_HALF_SPAN, GRID_HALF_SPAN + 0.5 * GRID_STEP, GRID_STEP):
        for line in (
            np.column_stack([along, np.full(61, place)]),
            np.column_stack([np.full(61, place), along]),
        ):
            points = np.round(optics.to_image(line) * 16.0).astype(np.int32)
            cv2.polylines(sheet, [points], False, 255, 1, cv2.LINE_AA, shift=4)
    return 1.0 - (1.0 - INK) * sheet.astype(np.float32) / 255.0
