from __future__ import annotations

import math

import cv2
import numpy as np
import pytest
from scripted_scene import HEIGHT, LENGTH, OPTICS, SCENE

from control.model import PIVOT_A, PIVOT_B, Body, Expectation, Frame, Pose, pivot_point
from vision import overlay
from vision.encoding import encode_jpeg
from vision.overlay import Drawing, draw_overlay
from vision.simulated.rendering import Painter
from vision.tracking.tracker import ColourTracker, TrackerSettings

BODY = Body(Pose(0.0, 0.0, 0.3), PIVOT_A, 0.0)
PICTURE = Painter(OPTICS, SCENE).paint(BODY, 0)


def colour_at(image: np.ndarray, x: float, y: float, height: float) -> tuple[int, ...]:
    u, v = OPTICS.to_pixel(x, y, height)
    return tuple(int(level) for level in image[round(v), round(u)])


def test_the_overlay_is_drawn_on_a_copy():
    before = PICTURE.copy()
    drawn = draw_overlay(PICTURE, OPTICS, Drawing(LENGTH, HEIGHT, BODY.pose))
    assert np.array_equal(PICTURE, before)
    assert not np.array_equal(drawn, before)


def test_the_ends_are_marked_where_they_are_seen():
    drawn = draw_overlay(PICTURE, OPTICS, Drawing(LENGTH, HEIGHT, BODY.pose, PIVOT_B))
    assert colour_at(drawn, *pivot_point(BODY.pose, PIVOT_A, LENGTH), HEIGHT) == overlay.END_A
    assert colour_at(drawn, *pivot_point(BODY.pose, PIVOT_B, LENGTH), HEIGHT) == overlay.END_B


def test_paths_lie_on_the_plate():
    angles = np.linspace(0.0, 2.0 * math.pi, 200)
    circle = 0.04 * np.column_stack([np.cos(angles), np.sin(angles)])
    drawn = draw_overlay(PICTURE, OPTICS, Drawing(LENGTH, HEIGHT, reference=circle, trail=0.5 * circle))
    assert np.abs(np.subtract(colour_at(drawn, 0.0, 0.04, 0.0), overlay.REFERENCE)).max() < 70
    assert np.abs(np.subtract(colour_at(drawn, 0.0, 0.02, 0.0), overlay.TRAIL)).max() < 70


def test_everything_at_once_and_nothing_at_all_can_be_drawn():
    tracker = ColourTracker(OPTICS, TrackerSettings(), LENGTH, HEIGHT)
    seen = tracker.update(Frame(PICTURE, 0.0, 0), Expectation(BODY.pose, 1e-4))
    missed = tracker.update(Frame(np.zeros_like(PICTURE), 1.0, 1), None)
    gap = np.array([[0.0, 0.0], [math.nan, 0.0], [0.01, 0.01]])
    for observation in (seen, missed):
        drawing = Drawing(LENGTH, HEIGHT, BODY.pose, PIVOT_A, observation, gap, gap, (0.01, 0.02))
        assert draw_overlay(PICTURE, OPTICS, drawing).shape == PICTURE.shape
    assert np.array_equal(draw_overlay(PICTURE, OPTICS, Drawing(LENGTH, HEIGHT)), PICTURE)


def test_a_picture_survives_jpeg():
    encoded = encode_jpeg(PICTURE)
    assert encoded.startswith(b"\xff\xd8")
    decoded = cv2.imdecode(np.frombuffer(encoded, np.uint8), cv2.IMREAD_COLOR)
    assert decoded is not None
    assert np.abs(decoded.astype(int) - PICTURE).mean() < 3.0
    assert len(encode_jpeg(PICTURE, 30)) < len(encoded)


@pytest.mark.parametrize("quality", [0, 101])
def test_a_quality_that_jpeg_does_not_have_is_refused(quality: int):
    with pytest.raises(ValueError, match=r"1\.\.100"):
        encode_jpeg(PICTURE, quality)
