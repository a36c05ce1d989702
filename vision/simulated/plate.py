"""The empty plate as the camera sees it: its colour, the printed grid, uneven light, and the sensor's noise."""

from __future__ import annotations

import math
from collections.abc import Sequence

import cv2
import numpy as np
from cv2.typing import MatLike
from numpy.typing import NDArray

from vision.camera_model import CameraModel

Image = MatLike
"""A picture (height, width, 3), uint8, BGR."""
Colour = tuple[float, float, float]
"""Blue, green, red; grey levels in full light."""

PLATE: Colour = (168.0, 172.0, 170.0)
"""Colour of the plate (a matt white plate, exposed to two thirds)."""
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


def light_over(size: tuple[int, int], gradient: float) -> NDArray:
    """Light over the picture (height, width): a slope along u and half of it along v, and vignetting."""
    width, height = size
    u = np.linspace(-0.5, 0.5, width, dtype=np.float32)[None, :]
    v = np.linspace(-0.5, 0.5, height, dtype=np.float32)[:, None]
    return (1.0 + gradient * (u + 0.5 * v)) * (1.0 - VIGNETTING * 2.0 * (u * u + v * v))


def noise_tile(size: tuple[int, int], sigma: float, random: np.random.Generator) -> tuple[Image, float]:
    """Sensor noise as unsigned levels round a mean, and that mean: the background is darkened by it."""
    width, height = size
    mean = float(math.ceil(4.0 * sigma))
    tile = random.standard_normal((height + NOISE_SPARE, width + NOISE_SPARE, 3), dtype=np.float32)
    return np.clip(np.rint(tile * sigma + mean), 0.0, 255.0).astype(np.uint8), mean


def mottle_over(size: tuple[int, int], random: np.random.Generator) -> NDArray:
    """Unevenness of the plate's paint (height, width), grey levels."""
    width, height = size
    mottle = cv2.GaussianBlur(random.standard_normal((height, width), dtype=np.float32), (0, 0), 2.0)
    mottle *= TEXTURE_SIGMA / float(mottle.std())
    return np.asarray(mottle)


def printed_grid(optics: CameraModel) -> NDArray:
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


def as_seen(surface: NDArray, colour: Sequence[float], mottle: NDArray, blur: float) -> NDArray:
    """A surface through the lens (height, width, 3), grey levels as float32.

    surface: brightness (height, width) with the light on it, 1 for the colour as it is.  blur: px.
    """
    seen = np.array(colour, np.float32) * surface[:, :, None] + mottle[:, :, None]
    return np.asarray(cv2.GaussianBlur(seen, (0, 0), blur)) if blur > 0.0 else seen


def to_levels(seen: NDArray, dark: float) -> Image:
    """Grey levels uint8, darkened by `dark`, which the noise's mean gives back."""
    return np.clip(np.rint(seen - dark), 0.0, 255.0).astype(np.uint8)
