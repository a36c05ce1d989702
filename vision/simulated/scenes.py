"""Scenes for trackers to be judged by: what the camera sees, and the truth at mid-exposure.

Equal seeds play alike, to the byte.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields, replace
from functools import lru_cache
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from control.model import Body, Frame
from vision.camera_model import CameraModel
from vision.simulated.company import debris, hand, twins
from vision.simulated.figures import top_surface
from vision.simulated.hand import Hand
from vision.simulated.props import (
    Ingredient,
    Moment,
    Setup,
    brightness,
    exposure_steps,
    flicker,
    glare,
    jpeg,
    motion_blur,
    moving_shadow,
)
from vision.simulated.rendering import Extras, Painter, SceneSettings
from vision.simulated.walking import Stride, Walk
from vision.tracking.colour import ColourRange

SHIPPED = ColourRange(hue=(340, 20), saturation=(110, 255), value=(60, 255))
"""Thresholds of the shipped robot's red."""

PLATES = 4
"""So many different plates and noises are made for the sequences of a scene."""
NOISE_STRIDE = 997
"""Between the noise of one sequence and the next, in frames: no two seeds see the same noise."""


@dataclass(frozen=True, slots=True)
class Scene:
    """words: what is in it.  ingredients: beside the robot.  stride: how the robot walks.

    colour, end_colour: what a tracker must be told of the robot and of the mark on its end A.
    is_hard: light, lens, litter or company make it harder than sensor noise does.
    """

    words: str
    ingredients: tuple[Ingredient, ...] = ()
    settings: SceneSettings = field(default=SceneSettings())
    optics: CameraModel = field(default=CameraModel.looking_down())
    stride: Stride = field(default=Stride())
    colour: ColourRange = field(default=SHIPPED)
    end_colour: ColourRange | None = None
    is_hard: bool = True

    def over(self, settings: SceneSettings) -> SceneSettings:
        """Other settings, with what is special in this scene's."""
        usual = SceneSettings()
        values = {one.name: getattr(self.settings, one.name) for one in fields(SceneSettings)}
        special = {name: value for name, value in values.items() if value != getattr(usual, name)}
        return replace(settings, **special)


@dataclass(frozen=True, slots=True)
class Shown:
    """One picture and the truth at its mid-exposure.

    body: None when the robot is not there.  visible: share of its top surface in the picture and not covered, 0..1.
    """

    frame: Frame
    body: Body | None
    visible: float


class Stage:
    """A scene that has been set up: says what each picture shows beside the robot."""

    def __init__(self, scene: Scene, setup: Setup) -> None:
        self._props = [ingredient(setup) for ingredient in scene.ingredients]

    def extras(self, moment: Moment) -> Extras:
        extras = Extras()
        for prop in self._props:
            extras = prop(extras, moment)
        return extras


def play(
    scene: Scene, seed: int, frames: int = 120, optics: CameraModel | None = None, *, robot: bool = True
) -> Iterator[Shown]:
    """The scene frame by frame. optics: instead of the scene's own.  robot: whether it is there at all."""
    optics = optics or scene.optics
    settings = replace(scene.settings, seed=seed % PLATES)
    random = np.random.default_rng([seed, 1])
    duration = frames / settings.rate
    walk = Walk(random, duration, scene.stride)
    painter = _painter(optics, settings)
    stage = Stage(scene, Setup(random, optics, settings, duration, walk.body(0.0), walk.body))
    for index in range(frames):
        time = index / settings.rate
        body = walk.body(time)
        extras = stage.extras(Moment(time, body, walk.body))
        image = painter.paint(body if robot else None, index + NOISE_STRIDE * seed, extras)
        share = visible_share(body, optics, settings, extras.hand) if robot else 0.0
        yield Shown(Frame(image, time, index), body if robot else None, share)


@lru_cache(maxsize=PLATES)
def _painter(optics: CameraModel, settings: SceneSettings) -> Painter:
    """Plate and noise take longer to make than a frame; sequences of one scene share some of them, in one thread."""
    return Painter(optics, settings)


def visible_share(body: Body, optics: CameraModel, settings: SceneSettings, hand: Hand | None) -> float:
    """Share of the top surface that is in the picture and not beneath the hand."""
    points = _surface_points(body, optics, settings)
    width, height = optics.size
    u, v = points.T
    seen = (u > -0.5) & (u < width - 0.5) & (v > -0.5) & (v < height - 0.5)
    if hand is not None:
        seen &= ~hand.covers(points)
    return float(seen.mean())


def _surface_points(body: Body, optics: CameraModel, settings: SceneSettings) -> NDArray:
    """Points (n, 2) px spread evenly over the top surface."""
    first, second, third, fourth = np.array(
        [
            optics.to_pixel(x, y, z)
            for x, y, z in top_surface(body, settings.length, settings.width, settings.height)
        ]
    )
    along = ((np.arange(10) + 0.5) / 10)[:, None, None]
    across = ((np.arange(5) + 0.5) / 5)[None, :, None]
    near, far = first + across * (second - first), fourth + across * (third - fourth)
    return (near + along * (far - near)).reshape(-1, 2)


BLUE_MARK = (190.0, 110.0, 40.0)
YELLOW = (50.0, 190.0, 215.0)
BLUE = (150.0, 75.0, 35.0)
GREEN = (60.0, 130.0, 40.0)
WOOD = (110.0, 155.0, 190.0)
WHITE = (185.0, 188.0, 190.0)
SLATE = (38.0, 36.0, 34.0)
DULL = (1.0, 0.93, 0.86)
WARM = (0.55, 0.85, 1.15)
"""Colours, and the tints of a dim lamp and of a warm one, BGR."""

STRONG_LENS = CameraModel.looking_down(height=0.18, distortion=(-0.30, 0.08, 0.001, -0.0005, 0.0))
"""A wide-angle lens near the plate: 40 px of barrel in the corners, and tangential terms."""
FAR_CAMERA = CameraModel.looking_down(height=0.65, picture_height=0.240)
"""The robot is 20 px long."""

SCENES: Mapping[str, Scene] = MappingProxyType(
    {
        "clean": Scene("Nothing but sensor noise.", is_hard=False),
        "dim": Scene("Little light, much noise.", (brightness(0.45, DULL),), SceneSettings(noise=5.0)),
        "warm": Scene("A warm lamp: little blue, much red.", (brightness(0.8, WARM),)),
        "shadow": Scene("Somebody's shadow wanders across; the robot's own turns.", (moving_shadow(0.55),)),
        "glare": Scene("A lamp's mirror image slides over plate and robot.", (glare(),)),
        "exposure_steps": Scene("The exposure jumps by 50 %.", (exposure_steps(),)),
        "flicker": Scene("Mains light in bands.", (flicker(0.35, 99.7),)),
        "motion_blur": Scene(
            "A quick robot and a long exposure.", (motion_blur(0.014),), stride=Stride(rate=5.0)
        ),
        "debris": Scene("Specks, fibres and flakes of the robot's colour lie about.", (debris(),)),
        "second_robot": Scene("A robot just like it walks about.", (twins(),)),
        "larger_twin": Scene("A larger robot of its kind walks about.", (twins(scale=1.4, keep=0.020),)),
        "standing_twins": Scene("Three robots like it stand about.", (twins(3, walking=False),)),
        "hand": Scene("A hand covers the robot for a while.", (hand(),)),
        "twin_and_hand": Scene("A hand, and a robot just like it.", (twins(keep=0.022), hand())),
        "larger_twin_and_hand": Scene(
            "A hand, and a larger robot of its kind.", (twins(scale=1.4, keep=0.025), hand())
        ),
        "jpeg": Scene("A camera that compresses to JPEG of quality 40 to 75.", (jpeg(40, 75),)),
        "strong_lens": Scene("A wide-angle lens.", optics=STRONG_LENS),
        "small_robot": Scene("A robot 20 px long.", optics=FAR_CAMERA),
        "end_mark": Scene(
            "A blue mark on end A.",
            settings=SceneSettings(end_mark=BLUE_MARK),
            end_colour=ColourRange(hue=(195, 225), saturation=(90, 255), value=(50, 255)),
            is_hard=False,
        ),
        "dark_plate": Scene(
            "A yellow robot on slate.",
            settings=SceneSettings(colour=YELLOW, plate=SLATE),
            colour=ColourRange(hue=(35, 70), saturation=(100, 255), value=(90, 255)),
        ),
        "blue_on_wood": Scene(
            "A blue robot on wood.",
            settings=SceneSettings(colour=BLUE, plate=WOOD),
            colour=ColourRange(hue=(195, 230), saturation=(90, 255), value=(50, 255)),
        ),
        "green_on_white": Scene(
            "A green robot on white.",
            settings=SceneSettings(colour=GREEN, plate=(200.0, 203.0, 204.0)),
            colour=ColourRange(hue=(85, 135), saturation=(90, 255), value=(40, 255)),
        ),
        "white_on_slate": Scene(
            "A white robot on slate: nothing to tell it by but its brightness.",
            settings=SceneSettings(colour=WHITE, plate=SLATE),
            colour=ColourRange(hue=(0, 360), saturation=(0, 90), value=(110, 255)),
        ),
        "everything": Scene(
            "Shadow, flicker, motion blur, litter and compression together.",
            (moving_shadow(0.4), flicker(0.2, 99.7), motion_blur(0.008), debris(8, 30), jpeg(60, 80)),
        ),
    }
)
"""By name."""
