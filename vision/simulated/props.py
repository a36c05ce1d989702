"""What may be in a scene beside the robot: each prop changes the extras of a picture, the same way for the same seed.

A prop is set up once for a scene and then says for each moment what the picture shows.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from control.model import Body
from vision.camera_model import CameraModel
from vision.simulated.figures import Shadow
from vision.simulated.light import MAINS_FLICKER, Band, Flicker, Glare
from vision.simulated.plate import Colour
from vision.simulated.rendering import Extras, SceneSettings

Path = Callable[[float], Body]
"""The body at a time, s."""

EXPOSURE = 0.004
"""Usual exposure time, s: short enough for 60 Hz in room light and long enough for mains flicker to show."""
SAMPLES_OVER_EXPOSURE = 9
"""A moving body is drawn so many times over the exposure: less than 0.3 px apart at 3 px of motion."""
SHADOW_EDGE = 25.0
"""Width of the edge of somebody's shadow, px: lamps are as wide as their distance from the plate allows."""
SLIDE = 0.012
"""A sliding spot begins and ends so far from the robot, m."""
MM = 1e-3


@dataclass(frozen=True, slots=True)
class Setup:
    """Where and for how long a scene plays.

    duration: after which things that come and go do so again, s.  path: of the robot, or None when it is not known
    beforehand.  start: the robot at first.
    """

    random: np.random.Generator
    optics: CameraModel
    settings: SceneSettings
    duration: float
    start: Body
    path: Path | None = None


@dataclass(frozen=True, slots=True)
class Moment:
    """One exposure. time: of its middle, s.  body: the robot then.  around: the body at a time nearby, s."""

    time: float
    body: Body
    around: Path


Prop = Callable[[Extras, Moment], Extras]
Ingredient = Callable[[Setup], Prop]


def motion_blur(exposure: float) -> Ingredient:
    """The robot's motion over the exposure, s."""
    shares = (np.arange(SAMPLES_OVER_EXPOSURE) + 0.5) / SAMPLES_OVER_EXPOSURE - 0.5

    def prop(extras: Extras, moment: Moment) -> Extras:
        bodies = (moment.around(moment.time + exposure * share) for share in shares.tolist())
        return replace(extras, moving=tuple(bodies))

    return lambda _: prop


def brightness(gain: float, tint: Colour = (1.0, 1.0, 1.0)) -> Ingredient:
    """Another brightness and colour of the light, always the same."""
    return lambda _: (
        lambda extras, _moment: replace(
            extras, light=replace(extras.light, gain=gain * extras.light.gain, tint=tint)
        )
    )


def exposure_steps(largest: float = 0.5, hold: tuple[float, float] = (0.10, 0.35)) -> Ingredient:
    """An automatic exposure that jumps by up to +-`largest` from one frame to the next and holds for a while, s."""

    def set_up(setup: Setup) -> Prop:
        holds = setup.random.uniform(*hold, size=64)
        ends = np.cumsum(holds)
        gains = 1.0 + setup.random.choice([-largest, 0.0, largest], size=64)

        def prop(extras: Extras, moment: Moment) -> Extras:
            gain = float(gains[np.searchsorted(ends, moment.time % ends[-1], side="right")])
            return replace(extras, light=replace(extras.light, gain=gain * extras.light.gain))

        return prop

    return set_up


def flicker(depth: float, frequency: float = MAINS_FLICKER) -> Ingredient:
    """A lamp on the mains through a rolling shutter: bands that wander."""

    def set_up(setup: Setup) -> Prop:
        begin = float(setup.random.uniform(0.0, 2.0 * math.pi))
        return lambda extras, moment: replace(
            extras,
            light=replace(extras.light, flicker=Flicker.at(moment.time, EXPOSURE, depth, frequency, begin)),
        )

    return set_up


def moving_shadow(strength: float) -> Ingredient:
    """Somebody's shadow wanders across the picture, and the robot's own turns with the light."""

    def set_up(setup: Setup) -> Prop:
        angle, turn, phase = setup.random.uniform((0.0, -1.0, 0.0), (math.pi, 1.0, 2.0 * math.pi)).tolist()
        width, height = setup.optics.size
        reach = 0.25 * math.hypot(width, height)

        def prop(extras: Extras, moment: Moment) -> Extras:
            offset = reach * math.sin(phase + 2.5 * moment.time)
            band = Band(angle, offset, 0.4 * reach, SHADOW_EDGE, strength)
            light = phase + turn * moment.time
            cast = Shadow(strength, (2.0 * MM * math.cos(light), 2.0 * MM * math.sin(light)))
            return replace(extras, light=replace(extras.light, band=band), shadow=cast)

        return prop

    return set_up


def glare(sigma: float = 0.8 * MM, strength: float = 350.0, miss: float = 2.5 * MM) -> Ingredient:
    """A lamp's mirror image slides past the robot, at most `miss` (m) beside its centre; another rests on the plate."""

    def set_up(setup: Setup) -> Prop:
        angle, beside, phase = setup.random.uniform((-math.pi, -miss, 0.0), (math.pi, miss, 1.0)).tolist()
        rest = setup.random.uniform(-0.05, 0.05, 2).tolist()
        scale = setup.optics.scale_at(0.0, 0.0)
        still = Glare(setup.optics.to_pixel(*rest), 5.0 * MM * scale, 2.5 * MM * scale, angle, 2.0 * strength)

        def prop(extras: Extras, moment: Moment) -> Extras:
            along = SLIDE * (2.0 * ((moment.time / setup.duration + phase) % 1.0) - 1.0)
            x = moment.body.pose.x + along * math.cos(angle) - beside * math.sin(angle)
            y = moment.body.pose.y + along * math.sin(angle) + beside * math.cos(angle)
            place = setup.optics.to_pixel(x, y, setup.settings.height)
            spot = Glare(place, sigma * scale, 0.7 * sigma * scale, angle, strength)
            return replace(extras, glare=(still, spot))

        return prop

    return set_up


def jpeg(low: int = 30, high: int = 50) -> Ingredient:
    """A camera that sends JPEG of a quality between these."""

    def set_up(setup: Setup) -> Prop:
        quality = int(setup.random.integers(low, high + 1))
        return lambda extras, _moment: replace(extras, jpeg_quality=quality)

    return set_up
