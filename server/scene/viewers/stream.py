"""What a viewer gets beside Viser's own stream: its layers, its eye and its camera picture, through one socket."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Awaitable, Callable, Sequence
from typing import Protocol

from viser._messages import Message

from server.scene.geometry import SceneGeometry
from server.scene.plate_pictures import PERIOD as PICTURE_PERIOD
from server.scene.plate_pictures import PlatePictures
from server.scene.viewers.known import Viewer
from server.scene.viewers.nodes import camera_nodes, eye_at, next_picture, switches, tops
from server.scene.viewers.steering import Steering
from server.scene.viewers.wire import frame_of
from server.scene.views import Place, Stand, stand

EYE_PERIOD = 1.0 / 30.0
"""Between two moves of the eye on its way, s."""
LOOK_PERIOD = 0.25
"""How often what the page is told is looked at again, s."""


class Stage(Protocol):
    """What there is to see, the same for all viewers. robot: cm.  full_field: T."""

    @property
    def geometry(self) -> SceneGeometry: ...

    @property
    def robot(self) -> Place | None: ...

    @property
    def full_field(self) -> float: ...

    @property
    def pictures(self) -> PlatePictures: ...


class OwnStream:
    def __init__(self, viewer: Viewer, stage: Stage, send: Callable[[bytes], Awaitable[None]]) -> None:
        self._viewer = viewer
        self._stage = stage
        self._send = send
        self._steering = Steering()
        self._aspect = 1.0
        self._shown = viewer.shown
        self._stirred = asyncio.Event()
        self._camera_shown = asyncio.Event()

    def hear(self, position: Place, look_at: Place, up: Place, aspect: float) -> None:
        """Where the viewer's eye is, as its browser says."""
        self._aspect = aspect
        self._steering.hear(Stand(position, look_at, up), time.monotonic())

    async def wishes(self) -> None:
        """The layers that the page asks for, and the views."""
        await self._tell(tops(self._shown))
        while True:
            self._viewer.wished.clear()
            await self._show_layers()
            self._take_view()
            await self._viewer.wished.wait()

    async def _show_layers(self) -> None:
        wanted = self._viewer.shown
        changed = sorted(wanted ^ self._shown)
        self._shown = wanted
        if "camera" in wanted:
            self._camera_shown.set()
        else:
            self._camera_shown.clear()
        if changed:
            await self._tell(switches(changed, wanted))

    def _take_view(self) -> None:
        view, self._viewer.view = self._viewer.view, None
        if view is None:
            return
        goal = stand(view.name, self._stage.geometry, self._stage.robot or (0.0, 0.0, 0.0), self._aspect)
        self._steering.ask(view.name, goal, time.monotonic(), smooth=view.smooth)
        self._stirred.set()

    async def eye(self) -> None:
        while True:
            if not self._steering.busy:
                self._stirred.clear()
                await self._stirred.wait()
            there = self._steering.step(self._stage.robot, time.monotonic())
            if there is not None:
                await self._tell(eye_at(there))
            await asyncio.sleep(EYE_PERIOD)

    async def camera(self) -> None:
        """The camera's picture, some times a second, while this viewer has it on."""
        last: object = None
        drawn: SceneGeometry | None = None
        while True:
            await self._camera_shown.wait()
            picture = await self._stage.pictures.newer_than(last)
            geometry = self._stage.geometry
            await self._tell(next_picture(picture) if geometry is drawn else camera_nodes(geometry, picture))
            last, drawn = picture.of, geometry
            await asyncio.sleep(PICTURE_PERIOD)

    async def reports(self) -> None:
        """What the page writes beside the scene."""
        while True:
            self._viewer.report(self._stage.full_field, follows=self._steering.follows)
            await asyncio.sleep(LOOK_PERIOD)

    async def _tell(self, messages: Sequence[Message]) -> None:
        await self._send(frame_of(messages))
