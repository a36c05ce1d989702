"""What the simulated camera sees beside the robot: the scene that is played in front of it, and what disturbs it."""

from __future__ import annotations

import numpy as np

from control.model import Body, swing, wrap
from vision.camera_model import CameraModel
from vision.simulated.disturbance import Disturbance, DisturbedSight
from vision.simulated.props import Moment, Path, Setup
from vision.simulated.rendering import Extras, SceneSettings
from vision.simulated.scenes import Scene, Stage

CYCLE = 6.0
"""What comes and goes in a scene does so again after this time, s."""
NO_SCENE = Scene("")


class Sight:
    """The extras of each frame of a camera whose world moves on its own. start: the robot at first."""

    def __init__(
        self,
        disturbance: Disturbance,
        optics: CameraModel,
        settings: SceneSettings,
        staged: Scene | None,
        start: Body,
    ) -> None:
        random = np.random.default_rng([settings.seed, 2])
        self._stage = Stage(staged or NO_SCENE, Setup(random, optics, settings, CYCLE, start))
        self._disturbed = DisturbedSight(disturbance, optics, settings)
        self._settings = settings
        self._last = 0, start

    def extras(self, index: int, body: Body) -> Extras:
        """Beside the robot with this body in the frame with this number."""
        moment = Moment(index / self._settings.rate, body, self._swinging(index, body))
        self._last = index, body
        return self._disturbed.over(self._stage.extras(moment), moment)

    def _swinging(self, index: int, body: Body) -> Path:
        """The body a little earlier and later, as it has turned about its pressed end since the last frame."""
        rate, (last_index, last) = self._settings.rate, self._last
        frames = max(1, index - last_index)
        turning = wrap(body.pose.heading - last.pose.heading) * rate / frames
        length = self._settings.length

        def around(time: float) -> Body:
            angle = turning * (time - index / rate)
            return Body(swing(body.pose, body.pivot, angle, length), body.pivot, body.tilt)

        return around
