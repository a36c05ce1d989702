"""The door to Viser: its page and its socket under our own address, one way for everything but the view.

Viser has no authentication, accepts any origin and lets each client ask for more than a view. So the browser
talks to us, and of what it says only a well-formed camera pose goes on. What one viewer alone is to see is put
between Viser's messages here.
"""

from __future__ import annotations

import asyncio
import logging
import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Literal

import msgspec
from starlette.websockets import WebSocket, WebSocketDisconnect
from viser import ViserServer
from websockets.asyncio.client import ClientConnection
from websockets.exceptions import ConnectionClosed
from websockets.typing import Subprotocol

from server.scene.private_viser import connect_to
from server.scene.viewers.known import Viewer
from server.scene.viewers.stream import OwnStream, Stage
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

    @property
    def aspect(self) -> float:
        """Width over height of the viewer's picture."""
        return max(0.2, min(5.0, self.image_width / self.image_height)) if self.image_height > 0.0 else 1.0


_decoder = msgspec.msgpack.Decoder(CameraPose)
_encoder = msgspec.msgpack.Encoder()


def admitted(message: bytes) -> CameraPose | None:
    """The camera pose that goes on to Viser, or None for every other message."""
    try:
        pose = _decoder.decode(message)
    except (msgspec.DecodeError, msgspec.ValidationError):
        return None
    return pose if pose.is_finite() else None


class Downlink:
    """Whole messages from several senders to one browser, one after the other."""

    def __init__(self, socket: WebSocket) -> None:
        self._socket = socket
        self._turn = asyncio.Lock()

    async def send(self, data: bytes) -> None:
        async with self._turn, asyncio.timeout(SEND_TIMEOUT):
            await self._socket.send_bytes(data)


class SceneBridge:
    """Counts who is looking, and carries bytes between each browser and Viser.

    viser: the scene's.  on_change: called on the event loop when a viewer comes or goes.
    stage: what there is to see.
    """

    def __init__(self, viser: Callable[[], ViserServer], on_change: Callable[[], None], stage: Stage) -> None:
        self._viser = viser
        self._on_change = on_change
        self._stage = stage
        self.viewers = 0
        self.refused = 0

    async def serve(self, socket: WebSocket, viewer: Viewer) -> None:
        protocol = next((name for name in socket.scope["subprotocols"] if name.startswith("viser-v")), None)
        if protocol is None:
            await socket.close(1002, "this is the 3D scene's own socket")
            return
        async with connect_to(
            self._viser(),
            subprotocols=[Subprotocol(protocol)],
            compression=None,
            max_size=None,
            max_queue=4,
            close_timeout=1.0,
            ping_interval=None,
        ) as viser_socket:
            await socket.accept(viser_socket.subprotocol)
            with self._counted(), viewer.streaming():
                await self._carry(socket, viser_socket, viewer)

    @contextmanager
    def _counted(self) -> Iterator[None]:
        self._count(1)
        try:
            yield
        finally:
            self._count(-1)

    def _count(self, change: int) -> None:
        self.viewers += change
        self._on_change()

    async def _carry(self, socket: WebSocket, viser_socket: ClientConnection, viewer: Viewer) -> None:
        poses = Mailbox[CameraPose](depth=1)
        down = Downlink(socket)
        own = OwnStream(viewer, self._stage, down.send)
        try:
            await until_first_ends(
                downwards(viser_socket, down),
                self._listen(socket, poses, own),
                upwards(poses, viser_socket),
                own.wishes(),
                own.eye(),
                own.camera(),
                own.reports(),
            )
        except (WebSocketDisconnect, ConnectionClosed):
            return
        except TimeoutError:
            log.info("a scene viewer took nothing for %g s and was dropped", SEND_TIMEOUT)
            return
        await close_quietly(socket)

    async def _listen(self, socket: WebSocket, poses: Mailbox[CameraPose], own: OwnStream) -> None:
        """The newest camera pose wins; a flood of them costs Viser no more than 30 a second."""
        while True:
            event = await socket.receive()
            if event["type"] == "websocket.disconnect":
                return
            pose = admitted(event.get("bytes") or b"")
            if pose is None:
                self.refused += 1
            else:
                poses.put(pose)
                own.hear(pose.position, pose.look_at, pose.up_direction, pose.aspect)


async def downwards(viser_socket: ClientConnection, down: Downlink) -> None:
    async for message in viser_socket:
        await down.send(message if isinstance(message, bytes) else message.encode())


async def upwards(poses: Mailbox[CameraPose], viser_socket: ClientConnection) -> None:
    while True:
        await viser_socket.send(_encoder.encode(await poses.get()))
        await asyncio.sleep(CAMERA_PERIOD)


async def close_quietly(socket: WebSocket) -> None:
    """Viser has ended: tell the browser, unless it has gone too."""
    try:
        async with asyncio.timeout(1.0):
            await socket.close(1012)
    except (WebSocketDisconnect, RuntimeError, TimeoutError):
        log.debug("the scene viewer had gone already")
