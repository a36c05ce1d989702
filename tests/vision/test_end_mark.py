"""A mark of another colour on end A tells head from tail, and does not pull centre or axis."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scripted_scene import OPTICS, anywhere

from control.model import Body
from vision.camera_model import CameraModel
from vision.simulated.rendering import Painter
from vision.simulated.scenes import FAR_CAMERA, SCENES
from vision.tracking.colour import RobotColours
from vision.tracking.detection import Blob, RegionFilter, find, measure

MARKED = SCENES["end_mark"]
COLOURS = RobotColours(MARKED.colour, MARKED.end_colour)


def blob_of(painter: Painter, optics: CameraModel, body: Body, index: int, colours: RobotColours) -> Blob:
    window = (0, 0, *optics.size)
    image = painter.paint(body, index)
    (candidate,) = find(image, window, colours, RegionFilter(80.0, 1200.0))
    return measure(image, window, candidate, colours)


def ahead_in_picture(optics: CameraModel, body: Body) -> tuple[float, float]:
    """From B to A, px."""
    x, y, heading = body.pose.x, body.pose.y, body.pose.heading
    u, v = optics.to_pixel(x, y, MARKED.settings.height)
    a_u, a_v = optics.to_pixel(
        x - 1e-3 * math.sin(heading), y + 1e-3 * math.cos(heading), MARKED.settings.height
    )
    return a_u - u, a_v - v


@pytest.mark.parametrize("optics", [OPTICS, FAR_CAMERA], ids=["37 px", "20 px"])
def test_the_mark_tells_the_end_at_any_heading(optics: CameraModel):
    painter, random = Painter(optics, MARKED.settings), np.random.default_rng(4)
    for index in range(40):
        body = anywhere(random)
        blob = blob_of(painter, optics, body, index, COLOURS)
        du, dv = ahead_in_picture(optics, body)
        along = du * math.cos(blob.axis) + dv * math.sin(blob.axis)
        assert blob.end == (1 if along > 0.0 else -1)


@pytest.mark.parametrize("optics", [OPTICS, FAR_CAMERA], ids=["37 px", "20 px"])
def test_the_mark_pulls_neither_the_centre_nor_the_axis(optics: CameraModel):
    painter, random = Painter(optics, MARKED.settings), np.random.default_rng(5)
    shifts, turns = [], []
    for index in range(60):
        body = anywhere(random)
        blob = blob_of(painter, optics, body, index, COLOURS)
        u, v = optics.to_pixel(body.pose.x, body.pose.y, MARKED.settings.height)
        du, dv = ahead_in_picture(optics, body)
        shifts.append(((blob.centre[0] - u) * du + (blob.centre[1] - v) * dv) / math.hypot(du, dv))
        turns.append((blob.axis - math.atan2(dv, du) + 0.5 * math.pi) % math.pi - 0.5 * math.pi)
    assert abs(np.mean(shifts)) <= 0.08
    assert np.mean(np.abs(shifts)) <= 0.12
    assert np.degrees(np.mean(np.abs(turns))) <= 0.4


def test_without_a_mark_the_end_is_not_told():
    plain = Painter(OPTICS, replace(MARKED.settings, end_mark=None))
    body = anywhere(np.random.default_rng(6))
    assert blob_of(plain, OPTICS, body, 0, COLOURS).end == 0
    assert blob_of(plain, OPTICS, body, 0, RobotColours(MARKED.colour)).end == 0
