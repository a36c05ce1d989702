"""The camera's newest picture as JPEG, encoded once for everybody who looks at the same view of it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from control.model import Frame
from server.settings import MM
from vision.encoding import encode_jpeg
from vision.overlay import Drawing, draw_overlay

if TYPE_CHECKING:
    from server.rig import Rig

View = Literal["raw", "overlay", "mask"]


@dataclass(frozen=True, slots=True)
class Picture:
    """One encoded frame. index: the frame's.  captured_at: mid-exposure on the rig's clock, s."""

    index: int
    captured_at: float
    jpeg: bytes


class Pictures:
    """Encodes on one thread of its own, so that any number of viewers costs at most one core's share."""

    def __init__(self, rig: Rig) -> None:
        self._rig = rig
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="jpeg")
        self._made: dict[View, tuple[Frame, asyncio.Future[bytes]]] = {}

    async def start(self) -> None:
        await asyncio.get_running_loop().run_in_executor(self._thread, bytes)

    def close(self) -> None:
        self._thread.shutdown(cancel_futures=True)

    async def newer_than(self, index: int | None, view: View) -> Picture:
        """The newest picture whose frame is not `index`; waits for one.

        Raises StreamEnded when the rig has stopped.
        """
        async with self._rig.updates.subscribe() as ticks:
            while (frame := self._rig.frame) is None or frame.index == index or self._rig.updates.closed:
                await ticks.get()
        return Picture(frame.index, frame.captured_at, await self.encoded(frame, view))

    async def encoded(self, frame: Frame, view: View) -> bytes:
        encoded, made = self._made.get(view, (None, None))
        if made is None or encoded is not frame:
            made = self._start(frame, view)
            self._made[view] = (frame, made)
        return await asyncio.shield(made)

    def _start(self, frame: Frame, view: View) -> asyncio.Future[bytes]:
        draw = {"raw": self._raw, "overlay": self._overlay, "mask": self._mask}[view]
        return asyncio.get_running_loop().run_in_executor(self._thread, draw(frame))

    def _raw(self, frame: Frame) -> Callable[[], bytes]:
        return lambda: encode_jpeg(frame.image)

    def _mask(self, frame: Frame) -> Callable[[], bytes]:
        return lambda: encode_jpeg(self._rig.machine.tracker.mask(frame.image))

    def _overlay(self, frame: Frame) -> Callable[[], bytes]:
        """What to draw is gathered on the event loop, where it holds still."""
        drawing, model = self._drawing(), self._rig.machine.camera_model
        return lambda: encode_jpeg(draw_overlay(frame.image, model, drawing))

    def _drawing(self) -> Drawing:
        rig, snapshot = self._rig, self._rig.snapshot
        return Drawing(
            length=rig.settings.robot.length_mm * MM,
            body_height=rig.machine.body_height,
            pose=snapshot.pose,
            pivot=snapshot.command.pivot,
            observation=snapshot.observation,
            reference=rig.reference_points(),
            trail=rig.trail(),
            target=snapshot.reference,
        )
