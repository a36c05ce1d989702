"""The door to Viser: its page and its socket under our own address, one way for everything but the view.

Viser has no authentication, accepts any origin and lets each client ask for more than a view. So the browser
talks to us, and of what it says only a well-formed camera pose goes on.
"""

from __future__ import annotations

import asyncio
import logging
import math
from collections.abc import Awaitable, Callable
from typing import Literal

import msgspec
from starlette.websockets import WebSocket, WebSocketDisconnect
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed
from websockets.typing import Subprotocol

from server.streams import Mailbox, until_first_ends

log = logging.getLogger(__name__)

CAMERA_PERIOD = 1.0 / 30.0
"""Shortest time between two camera poses of one client that are passed on, s."""
SEND_TIMEOUT = 10.0
"""A browser that takes nothing for this long is dropped, s; a slow one only gets fewer updates."""

Three = tuple[float, float, float]
Four = tuple[float, float, float, float]


class CameraPose(msgspec.Struct, forbid_unknown_fields=True):
    """Viser's ViewerCameraMessage, the only one that passes from a browser."""

    type: Literal["ViewerCameraMessage"]
    wxyz: Four
    position: Three
    fov: float
    near: float
    far: float
    image_height: float
    image_width: float
    look_at: Three
    up_direction: Three

    def is_finite(self) -> bool:
        vectors = (*self.wxyz, *self.position, *self.look_at, *self.up_direction)
        scalars = (self.fov, self.near, self.far, self.image_height, self.image_width)
        return all(map(math.isfinite, (*vectors, *scalars)))


_decoder = msgspec.msgpack.Decoder(CameraPose)
_encoder = msgspec.msgpack.Encoder()


def admitted(message: bytes) -> bytes | None:
    """The message as it goes on to Viser, or None for everything that is not a camera pose."""
    try:
        pose = _decoder.decode(message)
    except (msgspec.DecodeError, msgspec.ValidationError):
        return None
    return _encoder.encode(pose) if pose.is_finite() else None


class SceneBridge:
    """Counts who is looking, and carries bytes between each browser and Viser.

    port: where Viser listens on loopback.  on_change: called on the event loop when a viewer comes or goes.
    """

    def __init__(self, port: Callable[[], int], on_change: Callable[[], None]) -> None:
        self._port = port
        self._on_change = on_change
        self.viewers = 0
        self.refused = 0

    async def serve(self, socket: WebSocket) -> None:
        protocol = next((name for name in socket.scope["subprotocols"] if name.startswith("viser-v")), None)
        if protocol is None:
            await socket.close(1002, "this is the 3D scene's own socket")
            return
        async with connect(
            f"ws://127.0.0.1:{self._port()}/",
            subprotocols=[Subprotocol(protocol)],
            compression=None,
            max_size=None,
            max_queue=4,
            proxy=None,
            close_timeout=1.0,
            ping_interval=None,
        ) as viser_socket:
            await socket.accept(viser_socket.subprotocol)
            self._count(1)
            try:
                await self._carry(socket, viser_socket)
            finally:
                self._count(-1)

    def _count(self, change: int) -> None:
        self.viewers += change
        self._on_change()

    async def _carry(self, socket: WebSocket, viser_socket: ClientConnection) -> None:
        poses = Mailbox[bytes](depth=1)
        try:
            await until_first_ends(
                downwards(viser_socket, socket),
                self._listen(socket, poses),
                upwards(poses, viser_socket),
            )
        except (WebSocketDisconnect, ConnectionClosed):
            return
        except TimeoutError:
            log.info("a scene viewer took nothing for %g s and was dropped", SEND_TIMEOUT)
            return
        await close_quietly(socket)

    async def _listen(self, socket: WebSocket, poses: Mailbox[bytes]) -> None:
        """The newest camera pose wins; a flood of them costs Viser no more than 30 a second."""
        while True:
            event = await socket.receive()
            if event["type"] == "websocket.disconnect":
                return
            message = admitted(event.get("bytes") or b"")
            if message is None:
                self.refused += 1
            else:
                poses.put(message)


async def downwards(viser_socket: ClientConnection, socket: WebSocket) -> None:
    async for message in viser_socket:
        data = message if isinstance(message, bytes) else message.encode()
        await within(SEND_TIMEOUT, socket.send_bytes(data))


async def upwards(poses: Mailbox[bytes], viser_socket: ClientConnection) -> None:
    while True:
        await viser_socket.send(await poses.get())
        await asyncio.sleep(CAMERA_PERIOD)


async def within(limit: float, sending: Awaitable[None]) -> None:
    async with asyncio.timeout(limit):
        await sending


async def close_quietly(socket: WebSocket) -> None:
    """Viser has ended: tell the browser, unless it has gone too."""
    try:
        await within(1.0, socket.close(1012))
    except (WebSocketDisconnect, RuntimeError, TimeoutError):
        log.debug("the scene viewer had gone already")
