"""Named places to look at the scene from, in the scene's unit, the centimetre."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

from server.scene.geometry import CM, SceneGeometry
from vision.camera_model import CameraModel

ViewName = Literal["overview", "above", "along", "inside", "follow"]
VIEWS: tuple[ViewName, ...] = get_args(ViewName)

Place = tuple[float, float, float]

FIELD_OF_VIEW = math.radians(36.0)
"""Height of every view, rad; a perspective like that of a photograph of the rig."""
UP: Place = (0.0, 0.0, 1.0)
NORTH: Place = (0.0, 1.0, 0.0)
"""Up, where one looks straight down: the workspace's y axis."""
SQUARE = 1.0
"""Width over height of the picture that the distances below are made for; in a narrower one they grow."""

ROOMY = 0.6
"""Half of what the view from above spans, over the workspace's side, where no camera is calibrated."""
BEHIND_ROBOT: Place = (-1.6, -6.8, 4.6)
"""From the robot to who follows it, cm: below the upper coil, which would be in the way."""


@dataclass(frozen=True, slots=True)
class Stand:
    """Where the eye is, what it looks at and which way is up; cm."""

    position: Place
    look_at: Place
    up: Place = UP

    @property
    def distance(self) -> float:
        return math.dist(self.position, self.look_at)

    def towards(self, other: Stand, share: float) -> Stand:
        """The stand at 0..1 of the way to the other one: a turn about what is looked at, not a flight through it."""
        look_at = between(self.look_at, other.look_at, share)
        here, there = less(self.position, self.look_at), less(other.position, other.look_at)
        reach = math.hypot(*here) * (1.0 - share) + math.hypot(*there) * share
        offset = scaled_to(between(here, there, share), reach)
        return Stand(plus(look_at, offset), look_at, scaled_to(between(self.up, other.up, share), 1.0))


def stand(name: ViewName, geometry: SceneGeometry, robot: Place, aspect: float) -> Stand:
    """The place that a name stands for. robot: cm.  aspect: width over height of the viewer's picture."""
    side = 2.0 * geometry.workspace * CM
    if name == "above":
        found = as_the_camera(geometry.camera) if geometry.camera else straight_down(side)
    elif name == "follow":
        found = Stand(plus(robot, BEHIND_ROBOT), robot)
    elif name == "inside":
        found = Stand((-0.62 * side, -0.62 * side, 0.3 * side), (0.0, 0.0, 0.05 * side))
    elif name == "along":
        found = Stand((0.0, -1.8 * side, 0.22 * side), (0.0, 0.0, 0.02 * side))
    else:
        found = Stand((0.75 * side, -3.6 * side, 2.75 * side), (0.0, 0.0, -0.08 * side))
    return farther(found, max(1.0, SQUARE / aspect))


def straight_down(side: float) -> Stand:
    return Stand((0.0, 0.0, ROOMY * side / math.tan(0.5 * FIELD_OF_VIEW)), (0.0, 0.0, 0.0), NORTH)


def as_the_camera(camera: CameraModel) -> Stand:
    """On the camera's axis, as far off as its picture's height fills the view's."""
    rotation, translation = np.array(camera.rotation), np.array(camera.translation)
    eye, ahead, up = -rotation.T @ translation, rotation[2], -rotation[1]
    met = eye - ahead * eye[2] / ahead[2] if abs(ahead[2]) > 1e-3 else eye + ahead
    span = 0.5 * camera.size[1] / camera.fy
    distance = float(np.linalg.norm(met - eye)) * span / math.tan(0.5 * FIELD_OF_VIEW)
    return Stand(place(met - ahead * distance), place(met), place(up / CM))


def farther(stand: Stand, times: float) -> Stand:
    offset = less(stand.position, stand.look_at)
    return Stand(plus(stand.look_at, scaled_to(offset, stand.distance * times)), stand.look_at, stand.up)


def place(metres: np.ndarray) -> Place:
    x, y, z = (metres * CM).tolist()
    return x, y, z


def plus(a: Place, b: Place) -> Place:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def less(a: Place, b: Place) -> Place:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def between(a: Place, b: Place, share: float) -> Place:
    x, y, z = (p + share * (q - p) for p, q in zip(a, b, strict=True))
    return x, y, z


def scaled_to(a: Place, length: float) -> Place:
    """The same direction; of nothing, up."""
    norm = math.hypot(*a)
    if norm < 1e-9:
        return 0.0, 0.0, length
    x, y, z = (value * length / norm for value in a)
    return x, y, z
