"""The printed board in the hands of somebody who calibrates a simulated camera: flat, tilted, at every edge."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from vision.calibration.board import MODULES, Board
from vision.camera_model import CameraModel
from vision.simulated.board_view import BoardView

FINENESS = 2.0
"""The print is drawn with so many pixels for one of the picture's."""
RIM = 0.5
"""White paper round the squares, over the side of a square."""


@dataclass(frozen=True, slots=True)
class Holding:
    """How a board is held. tilt: turns about its own axes to the right and up, and about its normal, degrees.

    shift: to the right and up, over the height of what the camera sees.  height: of its middle above the plate,
    over that of the camera.
    """

    tilt: tuple[float, float, float]
    shift: tuple[float, float]
    height: float


FLAT = Holding((0.0, 0.0, 0.0), (0.0, 0.0), 0.0)
HELD = (
    FLAT,
    Holding((25.0, 0.0, 0.0), (0.0, 0.0), 0.09),
    Holding((-25.0, 0.0, 0.0), (0.0, 0.0), 0.09),
    Holding((0.0, 25.0, 0.0), (0.0, 0.0), 0.11),
    Holding((0.0, -25.0, 0.0), (0.0, 0.0), 0.11),
    Holding((17.0, 17.0, 17.0), (-0.23, 0.0), 0.09),
    Holding((-17.0, 17.0, -17.0), (0.23, 0.0), 0.09),
    Holding((17.0, -17.0, 29.0), (0.0, 0.23), 0.09),
    Holding((-17.0, -17.0, 0.0), (0.0, -0.23), 0.09),
    Holding((29.0, 11.0, 86.0), (0.0, 0.0), 0.14),
    Holding((11.0, 29.0, 46.0), (0.08, 0.08), 0.17),
    Holding((0.0, 0.0, 23.0), (0.0, 0.0), 0.23),
)
"""What a person shows who follows the hints: each side raised, each edge reached, near and far."""


def held_board(board: Board, optics: CameraModel, number: int) -> BoardView:
    """The board as it is held the `number`th time; after the last, from the beginning."""
    return shown_board(board, optics, HELD[number % len(HELD)])


def shown_board(board: Board, optics: CameraModel, holding: Holding) -> BoardView:
    """The board in front of a camera with these true optics."""
    scale = optics.scale_at(0.0, 0.0)
    image = board.image(FINENESS * scale)
    pixels_per_m = image.shape[1] / board.size[0]
    rim = round(RIM * MODULES) * (image.shape[1] // (board.columns * MODULES))
    sheet = np.pad(image, rim, constant_values=255).astype(np.uint8)
    turn = cv2.Rodrigues(np.radians(holding.tilt))[0]
    seen = optics.size[1] / scale
    height = holding.height * _camera_height(optics)
    middle = np.array([holding.shift[0] * seen, holding.shift[1] * seen, height])
    half_height, half_width = (0.5 * length / pixels_per_m for length in sheet.shape)
    corner = turn @ np.array([-half_width, half_height, 0.0]) + middle
    first, second, third = (turn @ np.diag([1.0, -1.0, -1.0])).tolist()
    x, y, z = corner.tolist()
    return BoardView(sheet, pixels_per_m, (tuple(first), tuple(second), tuple(third)), (x, y, z))


def _camera_height(optics: CameraModel) -> float:
    """Of the lens above the plate, m."""
    return float((-np.array(optics.rotation).T @ np.array(optics.translation))[2])
