"""What comes near the robot: others of its kind, litter on the plate, a hand."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from control.model import PIVOT_A, Body, Pose
from vision.camera_model import CameraModel
from vision.simulated.figures import Figure, Look
from vision.simulated.hand import Hand
from vision.simulated.plate import Colour
from vision.simulated.props import MM, Ingredient, Moment, Path, Prop, Setup
from vision.simulated.rendering import Extras
from vision.simulated.walking import Stride, Walk

PLACES_TRIED = 400
"""So many places or walks are drawn before the last one is taken although it is too near the robot."""
CHECKED_EVERY = 0.05
"""Distances between moving things are checked at these times, s."""
GREY_SPECK: Colour = (70.0, 72.0, 75.0)
SHORTEST_STAY = 0.05
"""Of a hand over the robot, s."""
LAST_LOOK = 0.15
"""At the end of a scene the robot is seen again for this long, s."""
PALM = 0.030
"""Radius of the palm as the camera sees it, m."""
OUT = 2.4
"""A palm so many of its radii beyond the border leaves no finger in the picture."""


def twins(count: int = 1, scale: float = 1.0, keep: float = 0.016, walking: bool = True) -> Ingredient:
    """Robots of the same kind, `scale` times as long and wide, whose centres keep `keep` (m) from the robot's.

    They stand still where the robot's path is not known, so as not to walk into it.
    """

    def set_up(setup: Setup) -> Prop:
        look = replace(
            setup.settings.look, length=scale * setup.settings.length, width=scale * setup.settings.width
        )
        stride = Stride(length=look.length)
        draw = _walking(setup, stride) if walking and setup.path is not None else _standing(setup)
        paths = [_kept_away(setup, draw, keep) for _ in range(count)]
        return lambda extras, moment: replace(
            extras, company=(*extras.company, *(Figure((path(moment.time),), look) for path in paths))
        )

    return set_up


def _walking(setup: Setup, stride: Stride) -> Callable[[], Path]:
    return lambda: Walk(setup.random, setup.duration, stride).body


def _standing(setup: Setup) -> Callable[[], Path]:
    def draw() -> Path:
        x, y, heading = setup.random.uniform((-0.05, -0.05, -math.pi), (0.05, 0.05, math.pi)).tolist()
        return lambda _: Body(Pose(x, y, heading), PIVOT_A, 0.0)

    return draw


def debris(bits: int = 14, specks: int = 60, gap: float = 1.0 * MM) -> Ingredient:
    """Grey specks anywhere; bits of the robot's colour, smaller or thinner than it, that keep a gap (m) from it."""

    def set_up(setup: Setup) -> Prop:
        litter = tuple(
            [_speck(setup) for _ in range(specks)] + [_bit(setup, gap, thin=i % 3 == 0) for i in range(bits)]
        )
        return lambda extras, _moment: replace(extras, litter=litter)

    return set_up


def _speck(setup: Setup) -> Figure:
    size = setup.random.uniform(0.15 * MM, 0.6 * MM)
    return Figure((_standing(setup)()(0.0),), Look(size, size, 0.0, GREY_SPECK))


def _bit(setup: Setup, gap: float, *, thin: bool) -> Figure:
    """A fibre (thin) or a flake; less than 5 mm^2 either way."""
    random = setup.random
    length, width = random.uniform((5.0, 0.3), (9.0, 0.5)) if thin else random.uniform((0.6, 0.5), (2.5, 2.0))
    shade = random.uniform(0.7, 1.1)
    blue, green, red = (shade * value for value in setup.settings.colour)
    look = Look(length * MM, width * MM, 0.0, (blue, green, red))
    keep = 0.5 * (
        math.hypot(setup.settings.length, setup.settings.width) + math.hypot(look.length, look.width)
    )
    return Figure((_kept_away(setup, _standing(setup), keep + gap)(0.0),), look)


def _distance(setup: Setup, path: Path) -> float:
    """Least distance of another thing's centre from the robot's, m."""
    if setup.path is None:
        times, robot = np.zeros(1), lambda _: setup.start
    else:
        times, robot = np.arange(0.0, setup.duration + CHECKED_EVERY, CHECKED_EVERY), setup.path
    bodies = [(robot(time).pose, path(time).pose) for time in times.tolist()]
    return min(one.distance_to(other.x, other.y) for one, other in bodies)


def _kept_away(setup: Setup, draw: Callable[[], Path], keep: float) -> Path:
    """A path that keeps this far (m) from the robot."""
    path = draw()
    for _ in range(PLACES_TRIED):
        if _distance(setup, path) >= keep:
            break
        path = draw()
    return path


def hand(longest: float = 0.6, reach: float = 0.25) -> Ingredient:
    """A hand comes in from the border, covers the robot and leaves again.

    longest: that it stays over the robot, s (drawn up to this and to what the scene's duration allows).
    reach: how long it takes to come and to go, s.
    """

    def set_up(setup: Setup) -> Prop:
        direction = float(setup.random.uniform(-math.pi, math.pi))
        begin = reach + float(setup.random.uniform(0.1, max(0.1, 0.2 * setup.duration)))
        most = min(longest, setup.duration - begin - reach - LAST_LOOK)
        stay = float(setup.random.uniform(SHORTEST_STAY, max(SHORTEST_STAY, most)))

        def prop(extras: Extras, moment: Moment) -> Extras:
            since = moment.time % setup.duration - begin
            away = max(-since / reach, (since - stay) / reach, 0.0)
            if away >= 1.0:
                return extras
            return replace(extras, hand=reaching(setup.optics, moment.body.pose, direction, away))

        return prop

    return set_up


def reaching(optics: CameraModel, pose: Pose, direction: float, away: float) -> Hand:
    """A hand on its way to the robot. direction: in the picture, rad.  away: 1 out of the picture, 0 over the robot."""
    place = optics.to_pixel(pose.x, pose.y)
    radius = PALM * optics.scale_at(0.0, 0.0)
    back = (-math.cos(direction), -math.sin(direction))
    distance = away * (_to_border(place, back, optics.size) + OUT * radius)
    return Hand((place[0] + distance * back[0], place[1] + distance * back[1]), direction, radius)


def _to_border(place: tuple[float, float], along: tuple[float, float], size: tuple[int, int]) -> float:
    """From a place in the picture along a direction (unit vector) to its border, px."""
    distances = [
        ((length if step > 0.0 else 0.0) - where) / step
        for where, step, length in zip(place, along, size, strict=True)
        if step != 0.0
    ]
    return max(0.0, min(distances))
