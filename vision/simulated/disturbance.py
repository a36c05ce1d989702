"""What is wrong with the simulated camera or in front of it, thrown like switches, and how that looks."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from control.model import Body, Pose
from vision.camera_model import CameraModel
from vision.simulated.company import debris, reaching
from vision.simulated.figures import Figure
from vision.simulated.light import Flicker, Glare
from vision.simulated.props import EXPOSURE, MM, Moment, Prop, Setup
from vision.simulated.rendering import Extras, SceneSettings

ARRIVAL = 0.2
"""A hand takes this long from the border to the robot, s."""
HAND_POINTS = math.radians(50.0)
"""Direction in the picture: from the upper left, rad."""
SPOT = 0.8 * MM
SPOT_BESIDE = 1.0 * MM
"""Standard deviation of a lamp's mirror image on the robot, and how far from its centre it lies, m."""
SPOT_STRENGTH = 350.0
"""Grey levels, added."""
NOBODY_KNOWS = 1.0
"""Duration that props without a course of events are set up for, s."""


@dataclass(slots=True)
class Disturbance:
    """What is wrong with the simulated camera; may be changed at any time, from any thread.

    hidden: the robot is not in the picture.  frozen: every frame repeats the last picture, with new times.
    unplugged: no frames.  extra_latency: added to the scene's latency, s.
    lost: share of the frames that never arrive.  mirrored: left is right.  cropped: half as wide and high.
    timeless: the capture time is NaN.
    light, exposure: how bright the lamp and how long the exposure is, relative to the usual.
    flicker: depth of the lamp's flicker on the mains, 0..1.  glare: a lamp's mirror image lies on the robot.
    twin: so far from where the robot was stands another one like it, m; 0: none.
    hand: a hand comes in and stays over the robot.  litter: bits and specks lie about.
    """

    hidden: bool = False
    frozen: bool = False
    unplugged: bool = False
    extra_latency: float = 0.0
    lost: float = 0.0
    mirrored: bool = False
    cropped: bool = False
    timeless: bool = False
    light: float = 1.0
    exposure: float = 1.0
    flicker: float = 0.0
    glare: bool = False
    twin: float = 0.0
    hand: bool = False
    litter: bool = False


class DisturbedSight:
    """Adds to a picture's extras what the switches say; remembers when and where it began."""

    def __init__(self, disturbance: Disturbance, optics: CameraModel, settings: SceneSettings) -> None:
        self._switches = disturbance
        self._optics = optics
        self._settings = settings
        self._twin: tuple[float, Figure] | None = None
        self._hand_since: float | None = None
        self._litter: Prop | None = None

    def over(self, extras: Extras, moment: Moment) -> Extras:
        switches = self._switches
        extras = self._with_light(extras, moment)
        if switches.glare:
            extras = replace(extras, glare=(*extras.glare, self._spot(moment.body.pose)))
        extras = self._with_twin(extras, moment)
        extras = self._with_hand(extras, moment)
        return self._with_litter(extras, moment)

    def _with_light(self, extras: Extras, moment: Moment) -> Extras:
        switches, light = self._switches, extras.light
        gain = switches.light * switches.exposure
        if gain != 1.0:
            light = replace(light, gain=light.gain * gain)
        if switches.flicker > 0.0:
            light = replace(light, flicker=Flicker.at(moment.time, EXPOSURE, switches.flicker))
        return extras if light is extras.light else replace(extras, light=light)

    def _spot(self, pose: Pose) -> Glare:
        """Towards end A of the robot, wherever it goes."""
        x = pose.x - SPOT_BESIDE * math.sin(pose.heading)
        y = pose.y + SPOT_BESIDE * math.cos(pose.heading)
        sigma = SPOT * self._optics.scale_at(0.0, 0.0)
        place = self._optics.to_pixel(x, y, self._settings.height)
        return Glare(place, sigma, sigma, strength=SPOT_STRENGTH)

    def _with_twin(self, extras: Extras, moment: Moment) -> Extras:
        distance = self._switches.twin
        if distance <= 0.0:
            self._twin = None
            return extras
        if self._twin is None or self._twin[0] != distance:
            self._twin = distance, Figure((beside(moment.body, distance),), self._settings.look)
        return replace(extras, company=(*extras.company, self._twin[1]))

    def _with_hand(self, extras: Extras, moment: Moment) -> Extras:
        if not self._switches.hand:
            self._hand_since = None
            return extras
        if self._hand_since is None:
            self._hand_since = moment.time
        away = max(0.0, 1.0 - (moment.time - self._hand_since) / ARRIVAL)
        return replace(extras, hand=reaching(self._optics, moment.body.pose, HAND_POINTS, away))

    def _with_litter(self, extras: Extras, moment: Moment) -> Extras:
        if not self._switches.litter:
            self._litter = None
            return extras
        if self._litter is None:
            random = np.random.default_rng([self._settings.seed, 3])
            self._litter = debris()(Setup(random, self._optics, self._settings, NOBODY_KNOWS, moment.body))
        return self._litter(extras, moment)


def beside(body: Body, distance: float) -> Body:
    """The same, this far (m) to the side nearer the middle, across the direction of walking: out of its way."""
    pose = body.pose
    away = distance * math.copysign(1.0, pose.x * math.sin(pose.heading) - pose.y * math.cos(pose.heading))
    x, y = pose.x - away * math.sin(pose.heading), pose.y + away * math.cos(pose.heading)
    return replace(body, pose=Pose(x, y, pose.heading), tilt=0.0)
