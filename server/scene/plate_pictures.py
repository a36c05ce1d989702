"""The camera's picture for the scene's plate, made once for all viewers who look at it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

from server.scene.geometry import SceneGeometry
from vision.camera_model import CameraModel
from vision.encoding import encode_jpeg
from vision.film import decode_jpeg
from vision.plate_view import PlateView
from vision.tracking.colour import Image

PERIOD = 0.2
"""Shortest time between two pictures on the plate, s: it is there to compare, the camera card to watch."""
SIDE = 480
"""Of the picture on the plate, px: 0.27 mm each on the 130 mm square."""
RIM = 0.005
"""Plate around the workspace that the picture covers, m."""


@dataclass(frozen=True, slots=True)
class Photograph:
    """image: BGR, or the bytes of a JPEG.  key: differs from picture to picture."""

    image: Image | bytes
    key: object


@dataclass(frozen=True, slots=True)
class PlatePicture:
    """jpeg: of the square of 2 * `half` (m) around the workspace's origin, seen from above.  of: its photograph."""

    jpeg: bytes
    half: float
    of: object


class PlatePictures:
    """newest: the photograph to show, None while there is none."""

    def __init__(
        self,
        thread: ThreadPoolExecutor,
        geometry: Callable[[], SceneGeometry],
        newest: Callable[[], Photograph | None],
    ) -> None:
        self._thread = thread
        self._geometry = geometry
        self._newest = newest
        self._made: PlatePicture | None = None
        self._view: tuple[CameraModel, PlateView] | None = None
        self._turn = asyncio.Lock()

    async def newer_than(self, last: object) -> PlatePicture:
        """The newest picture whose photograph is not `last`; waits for one."""
        while True:
            photograph = self._newest()
            if photograph is not None and photograph.key != last and self._geometry().camera is not None:
                made = await self._of(photograph)
                if made is not None:
                    return made
            await asyncio.sleep(PERIOD)

    async def _of(self, photograph: Photograph) -> PlatePicture | None:
        async with self._turn:
            if self._made is None or self._made.of != photograph.key:
                loop = asyncio.get_running_loop()
                made = await loop.run_in_executor(self._thread, self._make, photograph, self._geometry())
                if made is None:
                    return None
                self._made = made
            return self._made

    def _make(self, photograph: Photograph, geometry: SceneGeometry) -> PlatePicture | None:
        """None where the picture is not of the camera that is calibrated: a change of cameras is under way."""
        raw = photograph.image
        image = decode_jpeg(raw) if isinstance(raw, bytes) else raw
        camera, half = geometry.camera, geometry.workspace + RIM
        if camera is None or image is None or (image.shape[1], image.shape[0]) != camera.size:
            return None
        if self._view is None or self._view[0] is not camera:
            self._view = (camera, PlateView(camera, half, SIDE))
        return PlatePicture(encode_jpeg(self._view[1].of(image)), half, photograph.key)
