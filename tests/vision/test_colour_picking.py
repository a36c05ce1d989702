"""The robot's colour from one click: on whatever background, in whatever light, and what is said when it cannot be."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import cv2
import numpy as np
import pytest
from scripted_scene import HEIGHT, LENGTH, OPTICS, SCENE

from control.model import PIVOT_A, Body, Expectation, Frame, Pose, Tracking, opposite, swing
from vision.camera_model import CameraModel
from vision.simulated.rendering import Painter, SceneSettings
from vision.tracking.detection import Window, find
from vision.tracking.picking import Part, PickError, Proposal, Sight, pick
from vision.tracking.tracker import ColourTracker, TrackerSettings

Colour = tuple[float, float, float]

COLOURS: dict[str, tuple[Colour, Colour]] = {
    "red on white": ((40, 40, 200), (168, 172, 170)),
    "white on black": ((225, 225, 225), (30, 30, 30)),
    "black on white": ((30, 30, 30), (168, 172, 170)),
    "green on grey": ((60, 150, 50), (120, 120, 120)),
    "blue on wood": ((180, 80, 30), (90, 130, 170)),
    "yellow on white": ((30, 190, 205), (190, 192, 190)),
    "orange on skin": ((20, 110, 220), (140, 165, 205)),
    "magenta on green": ((160, 40, 180), (80, 140, 70)),
    "white on blue": ((220, 220, 220), (150, 80, 30)),
    "turquoise on black": ((190, 180, 30), (40, 38, 42)),
    "dark red on grey": ((25, 20, 90), (150, 150, 150)),
    "red on wood": ((40, 40, 200), (90, 130, 170)),
}
"""Robot and background, BGR grey levels in full light."""


@dataclass(frozen=True)
class Light:
    """What the camera makes of them. tint: factors on B, G, R.  gradient: over the picture's width.
    flicker: share by which the whole picture's brightness swings."""

    tint: Colour = (1.0, 1.0, 1.0)
    gradient: float = 0.15
    flicker: float = 0.0

    def on(self, colour: Colour) -> Colour:
        b, g, r = (min(part * factor, 255.0) for part, factor in zip(colour, self.tint, strict=True))
        return b, g, r

    def at(self, image: np.ndarray, index: int) -> np.ndarray:
        if not self.flicker:
            return image
        return cv2.convertScaleAbs(image, alpha=1.0 + self.flicker * math.sin(1.3 * index))


LIGHTS = {
    "dim": Light(tint=(0.35, 0.35, 0.35)),
    "warm": Light(tint=(0.6, 0.88, 1.12)),
    "from one side": Light(gradient=0.6),
    "nearly too bright": Light(tint=(1.3, 1.3, 1.3)),
    "flickering": Light(flicker=0.25),
}


def painter(colour: Colour, plate: Colour, light: Light = LIGHTS["warm"], **scene) -> Painter:
    settings = replace(
        SCENE, light_gradient=light.gradient, colour=light.on(colour), plate=light.on(plate), **scene
    )
    return Painter(OPTICS, settings)


def body_at(x: float, y: float, heading: float) -> Body:
    return Body(Pose(x, y, heading), PIVOT_A, 0.0)


def pixel(body: Body) -> tuple[float, float]:
    return OPTICS.to_pixel(body.pose.x, body.pose.y, HEIGHT)


def seen(image: np.ndarray, camera: CameraModel = OPTICS) -> Sight:
    return Sight(image, camera, HEIGHT, LENGTH)


def walk(frames: int) -> list[Body]:
    """Four frames at rest, then sweeps of 30 degrees about alternating ends, 2 degrees a frame, the free end raised."""
    bodies, pose, pivot = [body_at(-0.035, -0.03, 0.5)] * 4, Pose(-0.035, -0.03, 0.5), PIVOT_A
    for step in range(frames - len(bodies)):
        if step % 15 == 0:
            pivot = opposite(pivot)
        pose = swing(pose, pivot, math.radians(2.0) * pivot, LENGTH)
        bodies.append(Body(pose, pivot, math.radians(7.0)))
    return bodies


def expectation(body: Body) -> Expectation:
    return Expectation(body.pose, 2e-4, body.pivot, body.tilt)


def settings_of(proposal: Proposal) -> TrackerSettings:
    return TrackerSettings(colour=proposal.colour, region=proposal.region, heading_hint=0.5)


@pytest.mark.parametrize("light", LIGHTS)
@pytest.mark.parametrize("colours", COLOURS)
def test_from_one_click_on_the_robot_is_followed_in_every_frame_and_nothing_else_is_taken_for_it(
    colours: str, light: str, full: bool
):
    source, lamp = painter(*COLOURS[colours], LIGHTS[light]), LIGHTS[light]
    bodies = walk(60 if full else 12)
    first = lamp.at(source.paint(bodies[0], 0), 0)
    proposal = pick(seen(first), pixel(bodies[0]))
    tracker = ColourTracker(OPTICS, settings_of(proposal), LENGTH, HEIGHT)
    region = proposal.region.scaled(OPTICS.scale_at(0.0, 0.0, HEIGHT) ** 2)
    for index, body in enumerate(bodies):
        image = lamp.at(source.paint(body, index), index)
        assert len(find(image, (0, 0, 640, 480), proposal.colour, region)) == 1, index
        observation = tracker.update(
            Frame(image, index / 60, index), expectation(body) if index >= 4 else None
        )
        if index >= 3:
            assert observation.tracking is Tracking.LOCKED, (index, observation.reason)
            assert observation.measurement is not None
            assert observation.measurement.pose.distance_to(body.pose.x, body.pose.y) < 1.5e-4


def test_the_thresholds_bear_a_change_of_light_by_40_percent_where_the_background_allows_it():
    body = body_at(0.01, -0.02, 0.4)
    for colours in ("red on white", "white on black", "blue on wood", "yellow on white"):
        image = painter(*COLOURS[colours], Light()).paint(body, 1)
        proposal = pick(seen(image), pixel(body))
        assert proposal.light_change == 0.4
        for light in (0.6, 0.8, 1.2, 1.4):
            other = cv2.convertScaleAbs(image, alpha=light)
            blobs = find(
                other, (0, 0, 640, 480), proposal.colour, proposal.region.scaled(OPTICS.scale_at(0, 0) ** 2)
            )
            assert len(blobs) == 1, (colours, light)


def test_a_background_of_nearly_the_same_colour_is_told():
    body = body_at(0.01, -0.02, 0.4)
    image = painter((95, 95, 95), (150, 150, 150), Light(tint=(0.5, 0.5, 0.5)), shadow_strength=0.0).paint(
        body, 1
    )
    proposal = pick(seen(image), pixel(body))
    assert proposal.separation < 0.6
    assert any("light" in warning for warning in proposal.warnings)
    clear = pick(seen(painter(*COLOURS["red on white"]).paint(body, 1)), pixel(body))
    assert clear.separation == 1.0
    assert clear.warnings == ()


def test_the_area_is_that_of_the_clicked_robot_whatever_its_size():
    for length, width in ((0.005, 0.002), (0.010, 0.004), (0.018, 0.006)):
        body = body_at(0.01, -0.02, 0.4)
        image = painter(*COLOURS["red on white"], length=length, width=width).paint(body, 1)
        region = pick(Sight(image, OPTICS, HEIGHT, length), pixel(body)).region
        assert region.middle == pytest.approx(length * width, rel=0.25)
        assert region.area_min < length * width < region.area_max


@pytest.mark.parametrize("size", [(320, 240), (1920, 1080)])
def test_the_size_of_the_picture_does_not_matter(size: tuple[int, int]):
    camera, body = CameraModel.looking_down(size), body_at(0.01, -0.02, 0.4)
    image = Painter(camera, SCENE).paint(body, 1)
    proposal = pick(seen(image, camera), camera.to_pixel(0.01, -0.02, HEIGHT))
    assert proposal.region.middle == pytest.approx(LENGTH * SCENE.width, rel=0.25)
    assert proposal.warnings == ()


def test_a_click_anywhere_on_the_robot_gives_the_same_colours():
    body = body_at(0.01, -0.02, 0.4)
    image = painter(*COLOURS["red on white"]).paint(body, 1)
    ahead = math.cos(0.4 + math.pi / 2), math.sin(0.4 + math.pi / 2)
    masks = [
        pick(seen(image), OPTICS.to_pixel(0.01 + share * ahead[0], -0.02 + share * ahead[1], HEIGHT)).mask
        for share in (-0.0035, 0.0, 0.0035)
    ]
    assert all(np.count_nonzero(mask != masks[1]) < 0.1 * np.count_nonzero(masks[1]) for mask in masks)


def test_a_glare_spot_on_the_robot_does_not_split_it():
    body = body_at(0.01, -0.02, 0.4)
    image = painter(*COLOURS["blue on wood"]).paint(body, 1).copy()
    u, v = pixel(body)
    cv2.circle(image, (round(u), round(v)), 3, (255, 255, 255), cv2.FILLED)
    proposal = pick(seen(image), (u - 3, v - 10))
    assert proposal.region.middle == pytest.approx(LENGTH * SCENE.width, rel=0.3)


REFUSED = {
    "the empty plate": ((0.03, 0.03), "not on a blob"),
    "the picture's border": ((-0.085, 0.064), "not on a blob"),
    "the shadow": ((0.0142, -0.0236), "shadow"),
}


@pytest.mark.parametrize("what", REFUSED)
def test_a_click_beside_the_robot_is_refused_with_what_to_do(what: str):
    place, words = REFUSED[what]
    body = body_at(0.01, -0.02, 0.4)
    image = painter(*COLOURS["red on white"], shadow_strength=0.5, shadow_offset=(0.004, -0.003)).paint(
        body, 1
    )
    with pytest.raises(PickError, match=words) as refusal:
        pick(seen(image), OPTICS.to_pixel(*place, 0.0))
    assert "click" in str(refusal.value)


@pytest.mark.parametrize("part", ["body", "end_mark"])
def test_a_piece_of_the_plate_that_a_line_encloses_is_no_robot(part: Part):
    image = np.full((480, 640, 3), (198, 207, 24), np.uint8)
    cv2.rectangle(image, (15, 240), (380, 452), (85, 240, 215), 2)
    with pytest.raises(PickError, match="same colour"):
        pick(Sight(image, OPTICS, HEIGHT, 0.1), (121, 263), part)


@pytest.mark.parametrize(
    "place", [(-3.0, 20.0), (640.0, 20.0), (20.0, 480.0), (math.nan, 20.0), (math.inf, 1.0)]
)
def test_a_click_outside_the_picture_is_refused(place: tuple[float, float]):
    image = painter(*COLOURS["red on white"]).paint(None, 1)
    with pytest.raises(PickError, match="outside the picture"):
        pick(seen(image), place)


def test_a_robot_cut_by_the_border_is_refused():
    body = body_at(0.086, 0.0, 0.0)
    image = painter(*COLOURS["red on white"]).paint(body, 1)
    with pytest.raises(PickError, match="border of the picture"):
        pick(seen(image), pixel(body))


def test_a_crumb_is_too_small_to_be_the_robot():
    image = painter(*COLOURS["red on white"]).paint(None, 1).copy()
    cv2.circle(image, (300, 200), 2, (40, 40, 200), cv2.FILLED)
    with pytest.raises(PickError, match=r"mm² found, at least .* mm² needed"):
        pick(seen(image), (300, 200))


def test_a_robot_of_its_background_s_colour_cannot_be_picked():
    body = body_at(0.01, -0.02, 0.4)
    image = painter((168, 172, 170), (168, 172, 170), shadow_strength=0.0).paint(body, 1)
    with pytest.raises(PickError):
        pick(seen(image), pixel(body))


def test_other_blobs_of_the_same_looks_are_counted():
    body, others = body_at(0.01, -0.02, 0.4), [body_at(-0.03, 0.02, 1.0), body_at(0.04, 0.03, 2.0)]
    source = painter(*COLOURS["red on white"])
    image = source.paint(body, 1).copy()
    for other in others:
        u, v = (round(place) for place in pixel(other))
        image[v - 24 : v + 24, u - 24 : u + 24] = source.paint(other, 1)[v - 24 : v + 24, u - 24 : u + 24]
    warnings = pick(seen(image), pixel(body)).warnings
    assert any("2 other blobs that look the same" in warning for warning in warnings)


@pytest.mark.parametrize("far", [0.014, 0.026])
def test_a_twin_beside_the_robot_is_not_taken_for_the_background(far: float):
    body, twin = body_at(0.01, -0.02, 0.4), body_at(0.01 - far, -0.02, 1.2)
    source = painter(*COLOURS["red on white"])
    image = source.paint(body, 1).copy()
    u, v = (round(place) for place in pixel(twin))
    image[v - 22 : v + 22, u - 22 : u + 22] = source.paint(twin, 1)[v - 22 : v + 22, u - 22 : u + 22]
    proposal = pick(seen(image), pixel(body))
    assert proposal.separation == 1.0
    assert len(proposal.warnings) == 1
    assert "1 other blob that looks the same" in proposal.warnings[0]


def test_the_robot_s_colour_at_the_picture_s_border_is_told():
    body = body_at(0.01, -0.02, 0.4)
    image = painter(*COLOURS["red on white"]).paint(body, 1).copy()
    image[:, :25] = painter((40, 40, 200), (40, 40, 200)).paint(None, 1)[:, :25]
    warnings = pick(seen(image), pixel(body)).warnings
    assert any("border of the picture" in warning for warning in warnings)


def test_a_round_thing_is_told_to_have_no_heading():
    body = body_at(0.01, -0.02, 0.4)
    image = painter(*COLOURS["red on white"], length=0.006, width=0.006).paint(body, 1)
    assert any("no heading" in warning for warning in pick(seen(image), pixel(body)).warnings)


def test_the_mark_on_an_end_is_picked_apart_from_the_body():
    body = body_at(0.01, -0.02, 0.4)
    settings = replace(SCENE, end_mark=(60.0, 190.0, 60.0))
    image = Painter(OPTICS, settings).paint(body, 1)
    ahead = math.cos(0.4 + math.pi / 2), math.sin(0.4 + math.pi / 2)
    place = OPTICS.to_pixel(0.01 + 0.0042 * ahead[0], -0.02 + 0.0042 * ahead[1], HEIGHT)
    mark, robot = pick(seen(image), place, "end_mark"), pick(seen(image), pixel(body))
    assert not np.any((mark.mask > 0) & (robot.mask > 0))
    assert mark.region.middle < 0.6 * robot.region.middle
    assert mark.colour.hue[0] <= 120.0 <= mark.colour.hue[1]


@pytest.mark.parametrize("quality", [40, 80])
def test_jpeg_pictures_are_good_enough_to_pick_in(quality: int):
    body = body_at(0.01, -0.02, 0.4)
    for colours in ("red on white", "white on black", "green on grey"):
        image = painter(*COLOURS[colours]).paint(body, 1)
        _, data = cv2.imencode(".jpg", image, (cv2.IMWRITE_JPEG_QUALITY, quality))
        coarse = cv2.imdecode(data, cv2.IMREAD_COLOR)
        assert coarse is not None
        proposal = pick(seen(coarse), pixel(body))
        assert proposal.region.middle == pytest.approx(LENGTH * SCENE.width, rel=0.3)


def test_whatever_is_clicked_it_is_an_answer_at_that_place_or_a_refusal_in_words():
    random = np.random.default_rng(5)
    source = Painter(OPTICS, SceneSettings(seed=9))
    for index in range(20):
        x, y, heading = random.uniform((-0.06, -0.06, -3.0), (0.06, 0.06, 3.0)).tolist()
        image = source.paint(body_at(x, y, heading), index)
        u, v = random.uniform((0, 0), (640, 480)).tolist()
        answer = answered(image, u, v)
        if isinstance(answer, str):
            assert "click" in answer or "background" in answer
        else:
            assert answer[0] - 4 <= u <= answer[2] + 4
            assert answer[1] - 4 <= v <= answer[3] + 4


def answered(image: np.ndarray, u: float, v: float) -> Window | str:
    """The box of what was found there, or the refusal."""
    try:
        return pick(seen(image), (u, v)).box
    except PickError as refusal:
        return str(refusal)
