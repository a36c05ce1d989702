"""The printed board before a camera whose optics are known: rendered, or as the places of its corners."""

from __future__ import annotations

import numpy as np

from vision.calibration.board import Board, BoardFinder, Sighting
from vision.camera_model import CameraModel
from vision.simulated.held_board import FLAT, HELD, Holding, shown_board
from vision.simulated.rendering import Painter, SceneSettings

BOARD = Board()
MILD = CameraModel.looking_down()
STRONG = CameraModel.looking_down(tilt=(0.08, -0.05), distortion=(-0.3, 0.09, 0.002, -0.001, -0.01))
NEAR = CameraModel.looking_down(height=0.2, tilt=(0.03, 0.05), distortion=(-0.2, 0.05, 0.001, 0.0, 0.0))
HALF = 0.060
"""Of the workspace's side, m."""
STEPS = np.linspace(-HALF, HALF, 13)
WORKSPACE = np.array([(x, y) for x in STEPS for y in STEPS])


def rendered(optics: CameraModel, holdings: tuple[Holding, ...], seeds: int) -> list[list[Sighting]]:
    """For each seed of the sensor's noise the board as it is found in each holding's picture."""
    painter, finder = Painter(optics, SceneSettings(seed=7)), BoardFinder(BOARD)
    found: list[list[Sighting]] = [[] for _ in range(seeds)]
    for number, holding in enumerate(holdings):
        painter.show_board(shown_board(BOARD, optics, holding))
        for seed, sightings in enumerate(found):
            sighting = finder.find(painter.paint(None, number * seeds + seed))
            assert sighting is not None
            sightings.append(sighting)
    return found


def projected(optics: CameraModel, holding: Holding, noise: float, seed: int) -> Sighting:
    """The corners as the optics map them, with noise (px) and without a picture; those outside it are missing."""
    random = np.random.default_rng(seed)
    view = shown_board(BOARD, optics, holding)
    turn, corner = np.array(view.rotation), np.array(view.translation)
    height, width = (length / view.pixels_per_m for length in view.image.shape)
    flat = np.column_stack([BOARD.corners[:, 0] + 0.5 * width, 0.5 * height - BOARD.corners[:, 1]])
    places = flat @ turn[:, :2].T + corner
    pixels = np.array([optics.to_pixel(x, y, z) for x, y, z in places])
    pixels += random.normal(0.0, noise, pixels.shape)
    inside = np.all((pixels > 6.0) & (pixels < np.array(optics.size) - 7.0), axis=1)
    return Sighting(np.flatnonzero(inside), BOARD.corners[inside], pixels[inside], optics.size)


def projected_views(optics: CameraModel, noise: float, seed: int) -> list[Sighting]:
    return [
        projected(optics, holding, noise, seed * len(HELD) + number) for number, holding in enumerate(HELD)
    ]


def flat(optics: CameraModel, noise: float, seed: int) -> Sighting:
    return projected(optics, FLAT, noise, 10_000 + seed)


def true_error(model: CameraModel, optics: CameraModel) -> float:
    """RMS distance over the workspace between where things are and where the model says they are, m."""
    away = model.to_workspace(optics.to_image(WORKSPACE)) - WORKSPACE
    return float(np.sqrt(np.mean(np.sum(away**2, axis=1))))
