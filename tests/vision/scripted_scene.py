"""A world for the camera tests: a robot on a written path, in whole milliseconds as in the real world."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from control.model import PIVOT_A, PIVOT_B, Body, Pose
from vision.camera_model import CameraModel
from vision.simulated.rendering import SceneSettings

OPTICS = CameraModel.looking_down()
SCENE = SceneSettings(seed=7)
LENGTH, HEIGHT = SCENE.length, SCENE.height

Path = Callable[[float], Body]


def circling(time: float) -> Body:
    """Round a circle of 30 mm at 0.5 rad/s, facing along it, flat."""
    angle = 0.5 * time
    return Body(Pose(0.03 * math.cos(angle), 0.03 * math.sin(angle), angle + 0.5 * math.pi), PIVOT_A, 0.0)


class ScriptedWorld:
    """`path` gives the body at each world time, s."""

    def __init__(self, path: Path = circling) -> None:
        self._path = path
        self._milliseconds = 0

    @property
    def now(self) -> float:
        return self._milliseconds / 1000

    def advance_to(self, time: float) -> None:
        self._milliseconds = max(self._milliseconds, math.floor(time * 1000 + 1e-6))

    def body(self) -> Body:
        return self._path(self.now)


def anywhere(random: np.random.Generator, tilt: float = 0.0) -> Body:
    """A body at rest somewhere in the 120 mm workspace, whole in the picture."""
    x, y = random.uniform(-0.052, 0.052, 2)
    pivot = PIVOT_A if random.integers(2) else PIVOT_B
    return Body(Pose(x, y, random.uniform(-math.pi, math.pi)), pivot, tilt)
