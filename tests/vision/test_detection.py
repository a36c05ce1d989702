from __future__ import annotations

import math

import cv2
import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from scripted_scene import HEIGHT, OPTICS, SCENE, anywhere

from vision.simulated.rendering import Painter
from vision.tracking.colour import HUE_STEPS, ColourError, ColourRange
from vision.tracking.detection import Blob, RegionFilter, detect, find
from vision.tracking.tracker import RED

WHOLE = (0, 0, 640, 480)
REGION = RegionFilter(200.0, 1200.0)


def sole_blob(image: np.ndarray, colour: ColourRange = RED) -> Blob:
    (blob,) = detect(image, WHOLE, colour, REGION)
    return blob


def every_hue() -> np.ndarray:
    """A row of the 180 hues that OpenCV tells apart, in BGR."""
    hsv = np.full((1, HUE_STEPS, 3), 200, np.uint8)
    hsv[0, :, 0] = np.arange(HUE_STEPS)
    return cv2.cvtColor(hsv, cv2.COLOR_HSV2BGR)


@given(st.integers(0, 360), st.integers(0, 360))
@example(low=1, high=0)
@example(low=360, high=359)
def test_a_hue_range_holds_the_hues_between_its_ends_also_through_red(low: int, high: int):
    passes = ColourRange((low, high), (100, 255), (100, 255)).mask(every_hue())[0] > 0
    for step in range(HUE_STEPS):
        hue = 2 * step
        inside = low <= hue <= high if low <= high else hue >= low or hue <= high
        distance = min(abs((hue - end + 180) % 360 - 180) for end in (low, high))
        if distance > 4:
            assert passes[step] == inside, (low, high, hue)


def test_a_wrapping_range_gives_the_mask_of_its_two_halves():
    image = np.random.default_rng(1).integers(0, 256, (200, 200, 3)).astype(np.uint8)
    limits = ((110, 255), (60, 255))
    whole = ColourRange((340, 20), *limits).mask(image)
    below, above = (ColourRange(hue, *limits).mask(image) for hue in ((340, 360), (0, 20)))
    halves = np.maximum(below, above)
    assert np.mean(whole != halves) < 1e-3


@pytest.mark.parametrize(
    "wrong",
    [
        {"hue": (-1, 20)},
        {"hue": (0, 361)},
        {"hue": (math.nan, 20)},
        {"hue": (0, 20), "saturation": (200, 100)},
        {"hue": (0, 20), "value": (0, 256)},
    ],
)
def test_an_impossible_colour_range_is_refused(wrong: dict):
    with pytest.raises(ColourError):
        ColourRange(**wrong)


@pytest.mark.parametrize("limits", [(0.0, 1.0), (2.0, 1.0), (1.0, math.inf), (math.nan, 1.0)])
def test_an_impossible_region_filter_is_refused(limits: tuple[float, float]):
    with pytest.raises(ValueError, match="areas"):
        RegionFilter(*limits)


def test_centre_and_axis_are_good_to_a_fraction_of_a_pixel_everywhere():
    painter, random = Painter(OPTICS, SCENE), np.random.default_rng(5)
    offsets, turns = [], []
    for index in range(100):
        body = anywhere(random)
        blob = sole_blob(painter.paint(body, index))
        offsets.append(math.dist(blob.centre, OPTICS.to_pixel(body.pose.x, body.pose.y, HEIGHT)))
        turns.append((blob.axis + body.pose.heading) % math.pi - 0.5 * math.pi)
    assert np.mean(offsets) <= 0.1
    assert np.degrees(np.mean(np.abs(turns))) <= 0.4


def test_the_shadow_does_not_pull_the_centre():
    body = anywhere(np.random.default_rng(6))
    painters = [Painter(OPTICS, scene) for scene in (SCENE, type(SCENE)(seed=7, shadow_strength=0.0))]
    with_shadow, without = (
        np.mean([sole_blob(painter.paint(body, index)).centre for index in range(30)], axis=0)
        for painter in painters
    )
    assert math.dist(with_shadow, without) < 0.03


def test_the_corners_enclose_the_blob():
    body = anywhere(np.random.default_rng(8))
    blob = sole_blob(Painter(OPTICS, SCENE).paint(body, 0))
    assert math.dist(np.mean(blob.corners, axis=0), blob.centre) < 0.7
    assert cv2.contourArea(np.array(blob.corners, np.float32)) == pytest.approx(blob.area, rel=0.2)


def test_only_the_window_is_searched_and_places_are_those_of_the_whole_picture():
    body = anywhere(np.random.default_rng(9))
    image = Painter(OPTICS, SCENE).paint(body, 0)
    u, v = (round(place) for place in sole_blob(image).centre)
    window = (u - 40, v - 40, u + 40, v + 40)
    (blob,) = detect(image, window, RED, REGION)
    assert math.dist(blob.centre, sole_blob(image).centre) < 0.01
    assert detect(image, (0, 0, max(u - 60, 1), 480), RED, REGION) == []


def test_a_blob_of_the_wrong_size_is_no_candidate():
    image = Painter(OPTICS, SCENE).paint(anywhere(np.random.default_rng(10)), 0)
    area = sole_blob(image).area
    assert find(image, WHOLE, RED, RegionFilter(1.2 * area, 5 * area)) == []
    assert find(image, WHOLE, RED, RegionFilter(0.1 * area, 0.8 * area)) == []


def test_a_coarse_grid_finds_the_place_and_size_roughly():
    image = Painter(OPTICS, SCENE).paint(anywhere(np.random.default_rng(11)), 0)
    (candidate,) = find(image, WHOLE, RED, REGION, step=4)
    assert math.dist(candidate.centre, sole_blob(image).centre) < 6.0
    assert candidate.area == pytest.approx(sole_blob(image).area, rel=0.4)


@pytest.mark.parametrize("step", [2, 4, 8])
def test_a_coarse_look_sees_the_same_however_the_picture_lies_in_memory(step: int):
    image = Painter(OPTICS, SCENE).paint(anywhere(np.random.default_rng(13)), 0)
    within = np.zeros((480, 700, 3), np.uint8)
    within[:, :640] = image
    seen, cut = (
        find(each, WHOLE, RED, REGION.scaled(1.0, 2.0), step=step) for each in (image, within[:, :640])
    )
    assert len(seen) == 1
    assert [(each.box, each.area) for each in seen] == [(each.box, each.area) for each in cut]


@pytest.mark.parametrize(
    ("colour", "hue"), [((200, 60, 40), 235), ((40, 160, 40), 120), ((30, 200, 220), 57)]
)
def test_robots_of_other_colours_are_measured_as_well(colour: tuple[int, int, int], hue: int):
    scene = type(SCENE)(colour=colour)
    body = anywhere(np.random.default_rng(12))
    blob = sole_blob(
        Painter(OPTICS, scene).paint(body, 0), ColourRange((hue - 20, hue + 20), (80, 255), (40, 255))
    )
    assert math.dist(blob.centre, OPTICS.to_pixel(body.pose.x, body.pose.y, HEIGHT)) < 0.15


@pytest.mark.parametrize(
    ("colour", "plate", "value", "limit"),
    [
        ((225, 228, 226), (38, 36, 34), (150, 255), 0.15),
        ((30, 30, 32), (200, 203, 204), (0, 80), 0.15),
        ((120, 122, 121), (225, 228, 226), (60, 150), 0.25),
    ],
    ids=["white on slate", "black on white", "grey on white"],
)
def test_robots_without_a_colour_are_told_by_their_brightness(
    colour: tuple[int, int, int], plate: tuple[int, int, int], value: tuple[int, int], limit: float
):
    painter = Painter(OPTICS, type(SCENE)(colour=colour, plate=plate, shadow_strength=0.2))
    thresholds, random = ColourRange((0, 360), (0, 90), value), np.random.default_rng(13)
    apart = []
    for index in range(20):
        body = anywhere(random)
        u, v = OPTICS.to_pixel(body.pose.x, body.pose.y, HEIGHT)
        window = (
            max(round(u) - 40, 0),
            max(round(v) - 40, 0),
            min(round(u) + 40, 640),
            min(round(v) + 40, 480),
        )
        (blob,) = detect(painter.paint(body, index), window, thresholds, REGION)
        apart.append(math.dist(blob.centre, (u, v)))
    assert np.mean(apart) <= limit


def test_a_flicker_band_along_the_body_does_not_pull_the_centre():
    random, painter = np.random.default_rng(14), Painter(OPTICS, SCENE)
    rows = 1.0 + 0.35 * np.cos(np.arange(480) * (2.0 * math.pi * 1.5 / 480))[:, None, None]
    apart = []
    for index in range(30):
        body = anywhere(random)
        image = np.clip(np.rint(painter.paint(body, index) * rows), 0, 255).astype(np.uint8)
        blob = sole_blob(image)
        apart.append(math.dist(blob.centre, OPTICS.to_pixel(body.pose.x, body.pose.y, HEIGHT)))
    assert np.mean(apart) <= 0.1


@pytest.mark.parametrize("shift", [(0, 0), (10, -15), (-8, 12), (4, 6)])
def test_glare_on_the_robot_does_not_pull_its_centre(shift: tuple[int, int]):
    body = anywhere(np.random.default_rng(15))
    u, v = OPTICS.to_pixel(body.pose.x, body.pose.y, HEIGHT)
    columns, rows = np.meshgrid(np.arange(640), np.arange(480))
    spot = 350.0 * np.exp(-0.5 * ((columns - u - shift[0]) ** 2 + (rows - v - shift[1]) ** 2) / 2.5**2)
    image = Painter(OPTICS, SCENE).paint(body, 0) + spot[:, :, None]
    blob = sole_blob(np.clip(np.rint(image), 0, 255).astype(np.uint8))
    assert math.dist(blob.centre, (u, v)) <= 0.25
