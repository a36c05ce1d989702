"""A robot that is followed is read at a glance while nothing has changed; whatever has changed is looked at closely."""

from __future__ import annotations

import math
from dataclasses import replace

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scripted_scene import OPTICS, SCENE, anywhere

from control.model import PIVOT_A, Body, Pose
from vision.simulated.rendering import Painter
from vision.tracking.colour import RobotColours
from vision.tracking.detection import Blob, RegionFilter, Window, find, measure
from vision.tracking.reading import GLANCES, BlobReader
from vision.tracking.settings import RED

COLOURS = RobotColours(RED)
REGION = RegionFilter(200.0, 1200.0)
PAINTER = Painter(OPTICS, SCENE)
BODY = Body(Pose(0.010, -0.020, 0.4), PIVOT_A, 0.0)
HALF = 34


def window_of(body: Body) -> Window:
    u, v = (round(place) for place in OPTICS.to_pixel(body.pose.x, body.pose.y, SCENE.height))
    return u - HALF, v - HALF, u + HALF, v + HALF


def closely(image: np.ndarray, window: Window) -> Blob:
    (candidate,) = find(image, window, COLOURS, REGION)
    return measure(image, window, candidate, COLOURS)


def acquainted(body: Body = BODY) -> BlobReader:
    """A reader that has looked closely at the body."""
    reader, image, window = BlobReader(COLOURS), PAINTER.paint(body, 0), window_of(body)
    (candidate,) = find(image, window, COLOURS, REGION)
    reader.read(image, window, candidate)
    return reader


def painted_over(colour: tuple[int, int, int], shift: tuple[int, int], size: int) -> np.ndarray:
    """The body's picture with a square of a colour, `shift` px beside its centre."""
    image = PAINTER.paint(BODY, 1).copy()
    u0, v0, _, _ = window_of(BODY)
    u, v = u0 + HALF + shift[0], v0 + HALF + shift[1]
    cv2.rectangle(image, (u - size, v - size), (u + size, v + size), colour, cv2.FILLED)
    return image


def test_a_glance_says_the_same_as_a_close_look():
    random = np.random.default_rng(1)
    apart, turned = [], []
    for index in range(60):
        body = anywhere(random)
        there = acquainted(body)
        image, window = PAINTER.paint(body, index + 1), window_of(body)
        seen, looked = there.glance(image, window), closely(image, window)
        assert seen is not None
        apart.append(math.dist(seen.centre, looked.centre))
        turned.append(abs((seen.axis - looked.axis + 0.5 * math.pi) % math.pi - 0.5 * math.pi))
        assert seen.area == pytest.approx(looked.area, rel=0.05)
        assert seen.elongation == pytest.approx(looked.elongation, rel=0.05)
    assert np.mean(apart) <= 0.04
    assert np.degrees(np.mean(turned)) <= 0.25


def test_a_robot_that_turns_and_walks_is_still_read_at_a_glance():
    reader = acquainted()
    for index in range(1, GLANCES):
        body = Body(Pose(0.010 + 1e-4 * index, -0.020, 0.4 + 0.03 * index), PIVOT_A, 0.0)
        seen = reader.glance(PAINTER.paint(body, index), window_of(body))
        assert seen is not None
        assert math.dist(seen.centre, OPTICS.to_pixel(body.pose.x, body.pose.y, SCENE.height)) < 0.12


def test_after_some_glances_a_close_look_is_due():
    reader = acquainted()
    glances = [reader.glance(PAINTER.paint(BODY, index), window_of(BODY)) for index in range(GLANCES + 1)]
    assert [seen is not None for seen in glances] == [True] * GLANCES + [False]


def test_before_the_first_close_look_there_is_no_glance():
    assert BlobReader(COLOURS).glance(PAINTER.paint(BODY, 0), window_of(BODY)) is None


@pytest.mark.parametrize(
    "image",
    [
        painted_over((40, 40, 200), (25, -20), 2),
        painted_over((170, 172, 168), (-5, -12), 3),
        painted_over((150, 120, 90), (0, 0), 34),
        PAINTER.paint(None, 1),
        np.rint(0.8 * PAINTER.paint(BODY, 1)).astype(np.uint8),
        Painter(OPTICS, replace(SCENE, colour=(200.0, 40.0, 200.0))).paint(BODY, 1),
        Painter(OPTICS, replace(SCENE, length=0.0104)).paint(BODY, 1),
    ],
    ids=["another blob", "covered in part", "covered", "gone", "darker", "another colour", "longer"],
)
def test_what_has_changed_is_not_read_at_a_glance(image: np.ndarray):
    assert acquainted().glance(image, window_of(BODY)) is None


@settings(deadline=None)
@given(
    st.integers(0, 2**32 - 1),
    st.integers(0, 639),
    st.integers(0, 479),
    st.integers(1, 80),
    st.integers(1, 80),
)
def test_no_picture_and_no_window_breaks_a_reading(seed: int, u: int, v: int, width: int, height: int):
    random = np.random.default_rng(seed)
    blocks = random.integers(0, 256, (48, 64, 3)).astype(np.uint8)
    image = cv2.resize(blocks, (640, 480), interpolation=cv2.INTER_NEAREST)
    image[: 480 // (1 + seed % 3)] = random.integers(0, 256, 3)
    window = (u, v, min(u + width, 640), min(v + height, 480))
    reader = acquainted()
    reader.glance(image, window)
    for candidate in find(image, window, COLOURS, RegionFilter(0.5, 1e5)):
        blob = reader.read(image, window, candidate)
        assert all(math.isfinite(value) for value in (*blob.centre, blob.axis, blob.elongation))
        reader.glance(image, window)
