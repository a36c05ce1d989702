"""Keeps a scene up to date while somebody looks at it, on a thread of its own."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any, Generic, Protocol, TypeVar

from viser import ViserServer

from server.scene.bridge import SceneBridge
from server.scene.geometry import CM, SceneGeometry
from server.scene.plate_pictures import Photograph, PlatePictures
from server.scene.robot import LOOKS, Looks
from server.scene.scene import Scene, View
from server.scene.shapes import FULL_FIELD
from server.scene.views import Place
from server.streams import Cadence, Mailbox, Publisher, StreamEnded

T = TypeVar("T")
T_contra = TypeVar("T_contra", contravariant=True)

log = logging.getLogger(__name__)

PERIOD = 1.0 / 20.0
"""Shortest time between two updates, s."""


class Source(Protocol[T_contra]):
    """How that looks which there is to show. geometry: of the rig as it is now."""

    @property
    def geometry(self) -> SceneGeometry: ...

    def view(self, value: T_contra, /) -> View: ...

    def photograph(self) -> Photograph | None:
        """The camera's newest picture."""
        ...


class SceneFeed(Generic[T]):
    """A scene's life: its Viser starts, is fed while it has viewers, and ends."""

    def __init__(self, updates: Publisher[T], source: Source[T], looks: Sequence[Looks] = LOOKS[:1]) -> None:
        """updates: what there is to show, newest only.  looks: one for each robot."""
        self._updates = updates
        self._source = source
        self._looks = looks
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="scene")
        self._watched = asyncio.Event()
        self._task: asyncio.Task[None] | None = None
        self._shown: View | None = None
        self.scene: Scene | None = None
        self.pictures = PlatePictures(self._thread, lambda: self.geometry, source.photograph)
        self.bridge = SceneBridge(self._viser, self._viewers_changed, self)

    @property
    def geometry(self) -> SceneGeometry:
        return self._source.geometry

    @property
    def robot(self) -> Place | None:
        """Where the first robot is, in the scene's cm; None while that is not known."""
        pose = self._shown.robots[0].pose if self._shown else None
        return None if pose is None else (pose.x * CM, pose.y * CM, 0.0)

    @property
    def full_field(self) -> float:
        """The end of the field's colours, T."""
        return self._shown.full_field if self._shown else FULL_FIELD

    async def start(self) -> None:
        self.scene = scene = await self._on_thread(Scene, self._source.geometry, self._looks)
        self._task = asyncio.create_task(self._feed(scene), name="scene feed")

    async def stop(self) -> None:
        if self._task is not None:
            self._task.cancel()
            await asyncio.gather(self._task, return_exceptions=True)
        if self.scene is not None:
            await self._on_thread(self.scene.stop)
        self._thread.shutdown()

    def _viser(self) -> ViserServer:
        if self.scene is None:
            raise RuntimeError("the scene has not been started")
        return self.scene.server

    def _viewers_changed(self) -> None:
        if self.bridge.viewers:
            self._watched.set()
        else:
            self._watched.clear()

    async def _feed(self, scene: Scene) -> None:
        cadence = Cadence(PERIOD, asyncio.get_running_loop().time, asyncio.sleep)
        async with self._updates.subscribe() as mailbox:
            while True:
                await self._watched.wait()
                try:
                    await self._show_next(scene, mailbox)
                except StreamEnded:
                    return
                except Exception:  # the picture may fail, the rig does not notice (faults.md, rule 8)
                    log.exception("the 3D scene could not be brought up to date")
                    await asyncio.sleep(1.0)
                await cadence.wait()

    async def _show_next(self, scene: Scene, mailbox: Mailbox[T]) -> None:
        self._shown = view = self._source.view(await mailbox.get())
        await self._on_thread(scene.show, view)

    async def _on_thread(self, draw: Callable[..., Any], *what: Any) -> Any:
        return await asyncio.get_running_loop().run_in_executor(self._thread, draw, *what)
