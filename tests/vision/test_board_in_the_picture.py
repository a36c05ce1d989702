from __future__ import annotations

import itertools

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray
from scripted_scene import OPTICS, ScriptedWorld

from vision.camera_model import CameraModel, Rotation, Row
from vision.simulated.board_view import PAPER_LEVEL, BoardView, printed_board
from vision.simulated.camera import SyntheticCamera
from vision.simulated.rendering import Painter, SceneSettings
from vision.simulated.scenes import STRONG_LENS

PIXELS_PER_M = 16_000.0
PITCH = 0.012
RADIUS = 0.0035
"""Distance between the dots of the test print, and how far each reaches, m."""
COLUMNS, ROWS = 8, 6
MARGIN = 30
"""Dots nearer to the picture's border than this, px, may not be whole."""
STILL = SceneSettings(noise=0.0, light_gradient=0.0)
POSES = {
    "flat": ((0.0, 0.0, 0.0), 0.0),
    "turned": ((0.0, 0.0, 0.4), 0.0),
    "tilted": ((0.35, -0.2, 1.9), 0.02),
    "steep": ((-0.3, 0.5, -2.6), 0.03),
}


def darkness(x: NDArray, y: NDArray) -> NDArray:
    """Of a dot round the origin at places x (n), y (m), m: 1 in its middle, 0 beyond its radius (m, n)."""
    return 0.5 + 0.5 * np.cos(np.pi * np.minimum(np.hypot(y[:, None], x[None, :]) / RADIUS, 1.0))


def dots() -> NDArray[np.uint8]:
    """White paper with soft black dots, whose centre of darkness is their centre at any resolution."""
    height, width = round(ROWS * PITCH * PIXELS_PER_M), round(COLUMNS * PITCH * PIXELS_PER_M)
    x = ((np.arange(width) + 0.5) / PIXELS_PER_M) % PITCH - 0.5 * PITCH
    y = ((np.arange(height) + 0.5) / PIXELS_PER_M) % PITCH - 0.5 * PITCH
    return np.rint(255.0 * (1.0 - darkness(x, y))).astype(np.uint8)


def lying(turn: tuple[float, float, float], height: float) -> tuple[NDArray, NDArray]:
    """Rotation and translation of a print whose middle is above the plate's, face up, turned by a rotation vector."""
    rotation = cv2.Rodrigues(np.array(turn))[0] @ np.diag([1.0, -1.0, -1.0])
    middle = np.array([0.5 * COLUMNS * PITCH, 0.5 * ROWS * PITCH, 0.0])
    return rotation, np.array([0.0, 0.0, height]) - rotation @ middle


def view(rotation: NDArray, translation: NDArray) -> BoardView:
    first, second, third = (tuple(row) for row in rotation.tolist())
    turned: Rotation = (first, second, third)
    x, y, z = translation.tolist()
    place: Row = (x, y, z)
    return BoardView(dots(), PIXELS_PER_M, turned, place)


def centre_of_darkness(levels: NDArray, place: tuple[float, float], reach: float) -> NDArray:
    """(u, v) px of what is darker than paper within a circle round a place, px."""
    u0, v0, half = round(place[0]), round(place[1]), int(reach) + 1
    dark = PAPER_LEVEL - levels[v0 - half : v0 + half + 1, u0 - half : u0 + half + 1].astype(float)
    v, u = np.mgrid[v0 - half : v0 + half + 1, u0 - half : u0 + half + 1]
    dark *= np.hypot(u - place[0], v - place[1]) < reach
    return np.array([(u * dark).sum() / dark.sum(), (v * dark).sum() / dark.sum()])


def is_well_inside(place: tuple[float, float], size: tuple[int, int]) -> bool:
    return all(MARGIN < where < length - MARGIN for where, length in zip(place, size, strict=True))


def true_centre(optics: CameraModel, rotation: NDArray, translation: NDArray, x: float, y: float) -> NDArray:
    """Centre of darkness (u, v) px of the dot whose middle is at (x, y) m on the board: every point of it through
    the lens, weighted with the area that the picture gives it."""
    along = np.linspace(-RADIUS, RADIUS, 17)
    points = [
        optics.to_pixel(*(rotation @ [x + dx, y + dy, 0.0] + translation).tolist())
        for dy, dx in itertools.product(along, along)
    ]
    seen = np.array(points).reshape(17, 17, 2)
    (du_dy, du_dx), (dv_dy, dv_dx) = (np.gradient(seen[:, :, axis]) for axis in (0, 1))
    weight = darkness(along, along) * np.abs(du_dx * dv_dy - du_dy * dv_dx)
    return (weight[:, :, None] * seen).sum(axis=(0, 1)) / weight.sum()


@pytest.mark.parametrize("pose", POSES)
@pytest.mark.parametrize("optics", [OPTICS, STRONG_LENS], ids=["ordinary lens", "wide lens"])
def test_what_is_printed_lies_within_a_hundredth_of_a_pixel_of_where_the_lens_puts_it(
    pose: str, optics: CameraModel
) -> None:
    rotation, translation = lying(*POSES[pose])
    levels, _ = printed_board(view(rotation, translation), optics, blur=0.7)
    errors = []
    for column, row in itertools.product(range(COLUMNS), range(ROWS)):
        x, y = (column + 0.5) * PITCH, (row + 0.5) * PITCH
        dot = rotation @ [x, y, 0.0] + translation
        place = optics.to_pixel(*dot.tolist())
        if is_well_inside(place, optics.size):
            reach = 1.2 * RADIUS * optics.scale_at(*dot.tolist())
            seen = centre_of_darkness(levels, place, reach)
            errors.append(seen - true_centre(optics, rotation, translation, x, y))
    assert len(errors) > 20
    assert np.hypot(*np.array(errors).T).max() < 0.01


def test_a_board_that_is_shown_covers_the_robot_until_it_is_taken_away() -> None:
    camera = SyntheticCamera(ScriptedWorld(), OPTICS, STILL)
    with_robot = red_pixels(camera)
    camera.show_board(view(*lying(*POSES["flat"])))
    assert red_pixels(camera) == 0
    camera.show_board(None)
    assert red_pixels(camera) == pytest.approx(with_robot, rel=0.05)


def red_pixels(camera: SyntheticCamera) -> int:
    frame = camera.read(0.1)
    assert frame is not None
    blue, _, red = np.moveaxis(frame.image.astype(int), 2, 0)
    return int((red - blue > 60).sum())


def test_a_board_above_the_camera_is_refused() -> None:
    with pytest.raises(ValueError, match=r"below the camera at 0\.350 m"):
        Painter(OPTICS, STILL).show_board(view(*lying((0.0, 0.0, 0.0), 0.4)))


def test_the_paper_is_lit_and_noisy_like_the_plate() -> None:
    painter = Painter(OPTICS, SceneSettings(noise=3.0))
    painter.show_board(view(*lying(*POSES["flat"])))
    stack = np.stack([painter.paint(None, index) for index in range(30)]).astype(np.float32)
    assert stack.std(axis=0).mean() == pytest.approx(3.0, rel=0.05)
    assert stack[:, 100:380, 560:600].mean() > stack[:, 100:380, 40:80].mean() + 5
