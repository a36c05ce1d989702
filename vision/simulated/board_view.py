"""The printed calibration board in the simulated picture, through the whole lens model and anti-aliased."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from functools import lru_cache

import cv2
import numpy as np
from cv2.typing import MatLike
from numpy.typing import NDArray

from vision.camera_model import CameraModel, Rotation, Row

INK_LEVEL = 25.0
PAPER_LEVEL = 205.0
"""Grey levels in full light of what is printed black and white (laser print on office paper, assumed)."""
SUBSAMPLES = 4
"""Each pixel is the mean of so many samples along each side: with the blur, exact to 0.01 px."""
SOFTNESS = 0.5
"""Standard deviation by which the print is softened, as a share of the distance between samples."""
SHARP_ENOUGH = 0.3
"""A print is not softened by less than this, in its own pixels."""
WHOLE = 255
LEAST_COVER = 1e-6
"""Cover below this counts as none, so that nothing is divided by zero."""


@dataclass(frozen=True, slots=True)
class BoardView:
    """A printed board somewhere in front of the camera.

    image: (height, width) uint8, what is printed.  pixels_per_m: its resolution.
    rotation, translation: a point (x, y, 0) of the board, x to the right and y down from the upper left corner of
    the printed image (its edge, not its first pixel's middle), m, is R (x, y, 0) + t in the workspace, m.
    """

    image: NDArray[np.uint8]
    pixels_per_m: float
    rotation: Rotation
    translation: Row


def printed_board(view: BoardView, optics: CameraModel, blur: float) -> tuple[NDArray, NDArray]:
    """Grey levels in full light (height, width), and how much of each pixel the board covers, 0..1; both float32.

    blur: of the lens, px.
    """
    to_board = _plate_to_image(view, optics)
    x, y = _seen_plate(optics)
    source = _source(view, optics)
    total = np.zeros((*x.shape, 2), np.float32)
    slopes = [(np.gradient(place, axis=1), np.gradient(place, axis=0)) for place in (x, y)]
    steps = (np.arange(SUBSAMPLES) + 0.5) / SUBSAMPLES - 0.5
    for du, dv in itertools.product(steps, steps):
        px, py = (place + du * su + dv * sv for place, (su, sv) in zip((x, y), slopes, strict=True))
        total += _sampled(source, to_board, px, py)
    if blur > 0.0:
        total = cv2.GaussianBlur(total, (0, 0), blur)
    printed, cover = total[:, :, 0] / SUBSAMPLES**2, total[:, :, 1] / (SUBSAMPLES**2 * WHOLE)
    return printed / np.maximum(cover, LEAST_COVER), cover


def _plate_to_image(view: BoardView, optics: CameraModel) -> NDArray:
    """The homography from where a ray meets the plate (x, y; m) to where it meets the board (column, row; px).

    A board point W is seen at the plate point P on the line from the camera's place C: P = (C_z W - W_z C) / (C_z -
    W_z), which is linear in homogeneous coordinates.
    """
    cx, cy, cz = _place(optics)
    rotation, shift = np.array(view.rotation), np.array(view.translation)
    to_workspace = np.column_stack([rotation[:, :2] / view.pixels_per_m, shift])
    wx, wy, wz = to_workspace
    to_plate = np.array([cz * wx - cx * wz, cz * wy - cy * wz, [0.0, 0.0, cz] - wz])
    height, width = view.image.shape[:2]
    corners = np.array([[0.0, 0.0, 1.0], [width, 0.0, 1.0], [0.0, height, 1.0], [width, height, 1.0]])
    if not (to_plate[2] @ corners.T > 0.0).all():
        raise ValueError(f"the board must lie below the camera at {cz:.3f} m, got its corner at {shift} m")
    return np.linalg.inv(to_plate)


def _place(optics: CameraModel) -> NDArray:
    """Where the camera is in the workspace (x, y, z), m."""
    return -np.array(optics.rotation).T @ np.array(optics.translation)


@lru_cache(maxsize=2)
def _seen_plate(optics: CameraModel) -> tuple[NDArray, NDArray]:
    """Where each pixel's ray meets the plate: x and y (height, width), m."""
    width, height = optics.size
    v, u = np.indices((height, width), dtype=float)
    x, y = optics.to_workspace(np.column_stack([u.ravel(), v.ravel()])).T
    return x.reshape(height, width), y.reshape(height, width)


def _source(view: BoardView, optics: CameraModel) -> MatLike:
    """What is printed in grey levels, softened to what the samples can carry, and 255 (height, width, 2)."""
    levels = INK_LEVEL + (PAPER_LEVEL - INK_LEVEL) / 255.0 * view.image.astype(np.float32)
    pixels = view.pixels_per_m / optics.scale_at(*view.translation)
    sigma = SOFTNESS * pixels / SUBSAMPLES
    if sigma > SHARP_ENOUGH:
        levels = cv2.GaussianBlur(levels, (0, 0), sigma, borderType=cv2.BORDER_REPLICATE)
    printed = np.rint(levels).astype(np.uint8)
    return cv2.merge([printed, np.full_like(printed, WHOLE)])


def _sampled(source: MatLike, to_board: NDArray, x: NDArray, y: NDArray) -> MatLike:
    """The source where the rays through the plate points (m) meet it, 0 beside it."""
    a, b, c = to_board
    depth = c[0] * x + c[1] * y + c[2]
    column = ((a[0] * x + a[1] * y + a[2]) / depth - 0.5).astype(np.float32)
    row = ((b[0] * x + b[1] * y + b[2]) / depth - 0.5).astype(np.float32)
    return cv2.remap(source, column, row, cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT, borderValue=0)
