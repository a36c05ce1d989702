"""The camera: pictures for the page (acknowledged, newest only), for other viewers, and the calibration."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import AsyncIterator, Awaitable, Callable
from functools import partial
from typing import Any

from fastapi import APIRouter, Response, WebSocket
from fastapi.responses import StreamingResponse
from starlette.types import Message, Send

from server.api.access import ThePictures, TheRig
from server.api.body import StrictRoute
from server.api.problems import Problem, Rejected
from server.api.sockets import Line, listen, serve
from server.api.ticks import number, text
from server.calibration.optics import is_calibrated
from server.pictures import Picture, Pictures, View
from server.streams import Cadence, Publisher, StreamEnded, until_first_ends

router = APIRouter(tags=["camera"], route_class=StrictRoute)
sockets = APIRouter()

BOUNDARY = "picture"
STREAM_PERIOD = 1.0 / 30.0
"""Shortest time between two pictures of the MJPEG stream, s."""
STREAM_TIMEOUT = 10.0
"""A viewer that takes no picture for this long is dropped, s; a slow link only gets fewer of them."""
FAREWELL = 0.2
"""Time for a stream to end by itself when the rig stops, s."""
FIRST_PICTURE = 2.0
"""How long a snapshot waits for the first frame, s."""


@router.get("/camera")
async def camera(rig: TheRig) -> dict[str, Any]:
    """Size, rate and calibration: a pinhole with Brown-Conrady distortion, workspace (mm) to picture (px)."""
    model = rig.machine.camera_model
    return {
        "size": list(model.size),
        "rate_Hz": rig.settings.camera.rate_Hz,
        "calibrated": is_calibrated(rig.settings.camera),
        "model": {
            "fx": model.fx,
            "fy": model.fy,
            "cx": model.cx,
            "cy": model.cy,
            "distortion": list(model.distortion),
            "rotation": [value for row in model.rotation for value in row],
            "translation_mm": [value * 1e3 for value in model.translation],
            "body_height_mm": rig.machine.body_height * 1e3,
        },
    }


@router.get("/camera/snapshot.jpg", response_class=Response, responses={200: {"content": {"image/jpeg": {}}}})
async def snapshot(pictures: ThePictures, view: View = "raw") -> Response:
    """The newest picture."""
    try:
        async with asyncio.timeout(FIRST_PICTURE):
            picture = await pictures.newer_than(None, view)
    except (TimeoutError, StreamEnded):
        raise Rejected(Problem(503, "No picture", "The camera has not delivered a frame.")) from None
    return Response(picture.jpeg, media_type="image/jpeg")


@router.get("/camera/stream.mjpg", response_class=StreamingResponse)
async def stream(rig: TheRig, pictures: ThePictures, view: View = "raw") -> StreamingResponse:
    """An endless MJPEG stream for viewers other than the page."""
    return PictureStream(rig.updates, parts(pictures, view))


class PictureStream(StreamingResponse):
    """Ends with the rig, also for a viewer that has stopped reading and so never takes another picture."""

    def __init__(self, updates: Publisher[Any], content: AsyncIterator[bytes]) -> None:
        super().__init__(content, media_type=f"multipart/x-mixed-replace; boundary={BOUNDARY}")
        self._updates = updates

    async def stream_response(self, send: Send) -> None:
        async def send_in_time(message: Message) -> None:
            async with asyncio.timeout(STREAM_TIMEOUT):
                await send(message)

        with contextlib.suppress(TimeoutError):
            await until_first_ends(super().stream_response(send_in_time), self._over())

    async def _over(self) -> None:
        """A moment after the rig's end, in which a viewer that reads gets a proper end of the stream."""
        await self._updates.wait_closed()
        await asyncio.sleep(FAREWELL)


async def parts(pictures: Pictures, view: View) -> AsyncIterator[bytes]:
    cadence = Cadence(STREAM_PERIOD, asyncio.get_running_loop().time, asyncio.sleep)
    index: int | None = None
    while True:
        await cadence.wait()
        try:
            picture = await pictures.newer_than(index, view)
        except StreamEnded:
            return
        index, jpeg = picture.index, picture.jpeg
        yield f"--{BOUNDARY}\r\nContent-Type: image/jpeg\r\nContent-Length: {len(jpeg)}\r\n\r\n".encode()
        yield jpeg + b"\r\n"


@sockets.websocket("/camera")
async def pictures_to_page(
    socket: WebSocket, pictures: ThePictures, view: View = "raw", with_time: bool = False
) -> None:
    """One JPEG, then the newest one after each message of the client, so that none waits on the way.

    with_time: before each picture a text message says which frame it is and when it was captured.
    """
    await socket.accept()
    ready = asyncio.Event()
    ready.set()
    line = Line(socket)
    show = partial(send_with_time, line) if with_time else partial(send_picture, line)
    await serve(socket, listen(socket, ready.set), send_pictures(show, pictures, view, ready))


async def send_pictures(
    show: Callable[[Picture], Awaitable[None]], pictures: Pictures, view: View, ready: asyncio.Event
) -> None:
    index: int | None = None
    while True:
        await ready.wait()
        ready.clear()
        picture = await pictures.newer_than(index, view)
        index = picture.index
        await show(picture)


async def send_picture(line: Line, picture: Picture) -> None:
    await line.send_bytes(picture.jpeg)


async def send_with_time(line: Line, picture: Picture) -> None:
    """`captured_s` is on the clock of the ticks, and rounded as theirs, so that the two can be matched."""
    about = {"type": "picture", "frame": picture.index, "captured_s": number(picture.captured_at)}
    await line.send_text(text(about))
    await line.send_bytes(picture.jpeg)
