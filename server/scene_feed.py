"""Keeps the scene up to date while somebody looks at it, on a thread of its own."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, Any

import numpy as np

from server.scene import Scene, SceneGeometry
from server.scene_bridge import SceneBridge
from server.streams import Cadence, Mailbox, StreamEnded

if TYPE_CHECKING:
    from control.snapshot import Snapshot
    from server.rig import Rig

log = logging.getLogger(__name__)

PERIOD = 1.0 / 20.0
"""Shortest time between two updates, s."""
PATH_EVERY = 10
"""The path is asked for at each tenth update: it is worked out point by point and seldom changes."""


class SceneFeed:
    """The scene's life: Viser starts with the application, is fed while it has viewers, and ends with it."""

    def __init__(self, rig: Rig, geometry: Callable[[], SceneGeometry]) -> None:
        """geometry: of the rig as it is now; asked for again when its settings have changed."""
        self._rig = rig
        self._drawn_settings = rig.settings
        self._geometry = geometry
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="scene")
        self._watched = asyncio.Event()
        self._task: asyncio.Task[None] | None = None
        self._updates = 0
        self._path = np.zeros((0, 2))
        self.scene: Scene | None = None
        self.bridge = SceneBridge(self._viser_port, self._viewers_changed)

    async def start(self) -> None:
        loop = asyncio.get_running_loop()
        self.scene = scene = await loop.run_in_executor(self._thread, Scene, self._geometry())
        self._task = asyncio.create_task(self._feed(scene), name="scene feed")

    async def stop(self) -> None:
        if self._task is not None:
            self._task.cancel()
            await asyncio.gather(self._task, return_exceptions=True)
        if self.scene is not None:
            await asyncio.get_running_loop().run_in_executor(self._thread, self.scene.stop)
        self._thread.shutdown()

    def _viser_port(self) -> int:
        if self.scene is None:
            raise RuntimeError("the scene has not been started")
        return self.scene.port

    def _viewers_changed(self) -> None:
        if self.bridge.viewers:
            self._watched.set()
        else:
            self._watched.clear()

    async def _feed(self, scene: Scene) -> None:
        loop = asyncio.get_running_loop()
        cadence = Cadence(PERIOD, loop.time, asyncio.sleep)
        async with self._rig.updates.subscribe() as mailbox:
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

    async def _show_next(self, scene: Scene, mailbox: Mailbox[Snapshot]) -> None:
        snapshot = await mailbox.get()
        if self._drawn_settings is not self._rig.settings:
            self._drawn_settings = self._rig.settings
            await self._on_thread(scene.rebuild, self._geometry())
            self._updates = 0
        if self._updates % PATH_EVERY == 0:
            self._path = self._rig.reference_points()
        self._updates += 1
        await self._on_thread(scene.show, snapshot, self._path, self._rig.trail())

    async def _on_thread(self, draw: Callable[..., None], *what: Any) -> None:
        await asyncio.get_running_loop().run_in_executor(self._thread, draw, *what)
