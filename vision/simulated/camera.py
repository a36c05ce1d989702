"""The simulated camera: it lets the world run to each exposure, draws what is there, and delivers it late."""

from __future__ import annotations

import math
import random
import threading
import time
from collections import deque
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from control.model import Body, CameraNote, Frame
from vision.camera_model import CameraModel
from vision.simulated.board_view import BoardView
from vision.simulated.disturbance import Disturbance
from vision.simulated.rendering import Painter, SceneSettings
from vision.simulated.scenes import Scene
from vision.simulated.sight import Sight

__all__ = ["AsFastAsItGoes", "Disturbance", "Pace", "RealTime", "SceneSettings", "SyntheticCamera", "World"]

LONGEST_CATCH_UP = 2.0
"""A world that is further behind the clock than this, s (a suspended computer), goes on from where it is."""
LONGEST_QUEUE = 600
"""Frames on their way, at most: 10 s at 60 Hz; the oldest is lost."""
SAME_TIME = 1e-9
"""Two times closer than this, s, are the same: sums of frame periods round differently."""


class World(Protocol):
    """What is in front of the camera, with its own time, s."""

    @property
    def now(self) -> float: ...
    def advance_to(self, time: float, /) -> None: ...
    def body(self) -> Body: ...


class Pace(Protocol):
    """Couples world time to the rig's clock: rig time = world time + offset, s."""

    offset: float

    def begin(self, world_time: float) -> None: ...
    def now(self, world_time: float) -> float: ...
    def wait_until(self, rig_time: float) -> None: ...
    def jump(self, duration: float) -> None: ...
    def close(self) -> None: ...


class AsFastAsItGoes:
    """The rig's clock is the world's; nobody waits."""

    offset = 0.0

    def begin(self, world_time: float) -> None: ...

    def now(self, world_time: float) -> float:
        return world_time

    def wait_until(self, rig_time: float) -> None: ...

    def jump(self, duration: float) -> None:
        """The world's time is the rig's: it jumps when the world has been moved on."""

    def close(self) -> None: ...


class RealTime:
    """The rig's clock is the computer's monotonic one, and the world keeps up with it.

    stands_still: a computer that was too busy to look at the clock for this long, s, has not simulated
    anything meanwhile, and the rig's clock stands still for that time instead of ageing frames and commands
    that nobody could handle. None for a world with a board that runs by a clock of its own.
    """

    def __init__(self, stands_still: float | None = None) -> None:
        self.offset = 0.0
        self._stands_still = math.inf if stands_still is None else stands_still
        self._stood = 0.0
        self._looked = time.monotonic()
        self._closed = threading.Event()

    def begin(self, world_time: float) -> None:
        self.offset = self._clock() - world_time

    def now(self, world_time: float) -> float:  # noqa: ARG002  # the world follows this clock
        return self._clock()

    def wait_until(self, rig_time: float) -> None:
        """Returns at `rig_time`, or at once when the camera is closed."""
        self._closed.wait(max(0.0, rig_time - self._clock()))
        self._looked = max(self._looked, rig_time)

    def jump(self, duration: float) -> None:
        """It is later than it was, by so much (s): the computer has slept, or its clock was put forward."""
        self._stood -= duration
        self._looked += duration

    def close(self) -> None:
        self._closed.set()

    def _clock(self) -> float:
        now = time.monotonic() - self._stood
        if now - self._looked > self._stands_still:
            self._stood += now - self._looked
            now = self._looked
        self._looked = max(self._looked, now)
        return self._looked


@dataclass(frozen=True, slots=True)
class Exposure:
    """What was in front of the camera at one capture time (rig clock, s)."""

    index: int
    captured_at: float
    body: Body


class SyntheticCamera:
    """Satisfies the loop's camera protocol; the world moves only while somebody reads."""

    simulated = True
    identity = "simulated camera"
    trouble = ""

    def __init__(
        self,
        world: World,
        optics: CameraModel,
        scene: SceneSettings | None = None,
        pace: Pace | None = None,
        staged: Scene | None = None,
    ) -> None:
        """staged: a scene that is played in front of the camera, for ever."""
        self.disturbance = Disturbance()
        self._scene = scene or SceneSettings() if staged is None else staged.over(scene or SceneSettings())
        self._world = world
        self._painter = Painter(optics, self._scene)
        self._sight = Sight(self.disturbance, optics, self._scene, staged, world.body())
        self._pace = pace or AsFastAsItGoes()
        self._pace.begin(world.now)
        self._first = world.now
        self._next_index = 0
        self._waiting: deque[Exposure] = deque(maxlen=LONGEST_QUEUE)
        self._last_image: NDArray[np.uint8] | None = None
        self._chance = random.Random(self._scene.seed)
        self._closed = False
        self.size = optics.size
        self.rate = self._scene.rate

    def now(self) -> float:
        """The clock that stamps the frames: world time, or the monotonic clock in real time, s."""
        return self._pace.now(self._world.now)

    def require(self) -> None:
        """It is there as long as its world is."""

    def take_notes(self) -> list[CameraNote]:
        """What it does is as asked."""
        return []

    def read(self, timeout: float) -> Frame | None:
        """The newest frame when it is delivered; None when none comes within `timeout` (rig time, s)."""
        if self._closed:
            return None
        start = self.now()
        self._forgive(start)
        exposure = None if self.disturbance.unplugged else self._expect(start, start + timeout)
        if exposure is None:
            self._pass_until(start + timeout)
            return None
        image = self._picture(exposure)
        self._pass_until(self._due(exposure.captured_at))
        if self._closed:
            return None
        return Frame(self._deformed(image), self._stamp(exposure), exposure.index)

    def show_board(self, view: BoardView | None) -> None:
        """Lays a printed board over the robot, or takes it away; from any thread. Raises ValueError."""
        self._painter.show_board(view)

    def pass_time(self, duration: float) -> None:
        """Lets rig time pass (s) without a picture: whoever should read is busy with something else."""
        self._pass_until(self.now() + duration)

    def jump(self, duration: float) -> None:
        """Puts the rig's clock forward (s); the world has gone on meanwhile."""
        later = self.now() + duration
        self._pace.jump(duration)
        self._expose_until(later)

    def close(self) -> None:
        """Ends a read that is waiting; later reads return None."""
        self._closed = True
        self._pace.close()

    def _stamp(self, exposure: Exposure) -> float:
        """The capture time that a frame that is delivered now bears, s."""
        if self.disturbance.timeless:
            return math.nan
        assumed = self._scene.assumed_latency
        return exposure.captured_at if assumed is None else self.now() - assumed

    def _due(self, captured_at: float) -> float:
        return captured_at + self._scene.latency + self.disturbance.extra_latency

    def _forgive(self, now: float) -> None:
        """Moves the clocks apart when the world cannot catch up; the frames of that time are lost."""
        if now - self._pace.offset - self._world.now > LONGEST_CATCH_UP:
            self._waiting.clear()
            self._pace.begin(self._world.now)

    def _expect(self, start: float, deadline: float) -> Exposure | None:
        """The exposure to deliver next, once the world has got there; None when due after `deadline`."""
        self._expose_until(start)
        while len(self._waiting) > 1 and self._due(self._waiting[1].captured_at) <= start + SAME_TIME:
            self._waiting.popleft()
        while not self._waiting and self._due(self._next_capture()) <= deadline + SAME_TIME:
            self._pass_until(self._next_capture())
        if self._waiting and self._due(self._waiting[0].captured_at) <= deadline + SAME_TIME:
            return self._waiting.popleft()
        return None

    def _pass_until(self, rig_time: float) -> None:
        """Waits; then world and clock agree, so that a command finds the board at the time it is given."""
        self._pace.wait_until(rig_time)
        if not self._closed:
            self._expose_until(max(rig_time, self.now()))

    def _next_capture(self) -> float:
        """Capture time of the next exposure on the rig's clock, s."""
        return self._first + self._next_index / self._scene.rate + self._pace.offset

    def _expose_until(self, rig_time: float) -> None:
        """Lets the world run to `rig_time` and remembers what the camera sees on the way.

        A world of whole steps stands a little before the nominal capture time; the frame is stamped with
        the time of what it shows.
        """
        while (capture := self._next_capture()) <= rig_time + SAME_TIME:
            self._world.advance_to(capture - self._pace.offset)
            self._remember(self._world.now + self._pace.offset)
            self._next_index += 1
        self._world.advance_to(rig_time - self._pace.offset)

    def _remember(self, captured_at: float) -> None:
        if self.disturbance.unplugged:
            self._waiting.clear()
            return
        if self._chance.random() < self.disturbance.lost:
            return
        self._waiting.append(Exposure(self._next_index, captured_at, self._world.body()))

    def _picture(self, exposure: Exposure) -> NDArray[np.uint8]:
        if not (self.disturbance.frozen and self._last_image is not None):
            extras = self._sight.extras(exposure.index, exposure.body)
            body = None if self.disturbance.hidden else exposure.body
            self._last_image = self._painter.paint(body, exposure.index, extras)
        return self._last_image

    def _deformed(self, image: NDArray[np.uint8]) -> NDArray[np.uint8]:
        if self.disturbance.mirrored:
            image = np.ascontiguousarray(image[:, ::-1])
        return np.ascontiguousarray(image[::2, ::2]) if self.disturbance.cropped else image
