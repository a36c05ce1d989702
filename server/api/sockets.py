"""One client's WebSocket: sends with a time limit, and ends quietly when the client or the server goes."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Coroutine, Mapping
from typing import Any

from starlette.websockets import WebSocket, WebSocketDisconnect, WebSocketDisconnected

from server.streams import StreamEnded, until_first_ends

log = logging.getLogger(__name__)

SEND_TIMEOUT = 0.5
"""A client that takes nothing for this long is dropped, s (faults.md row 25)."""


class Line:
    """Whole messages from several senders to one client."""

    def __init__(self, socket: WebSocket) -> None:
        self._socket = socket
        self._turn = asyncio.Lock()

    async def send_text(self, text: str) -> None:
        async with asyncio.timeout(SEND_TIMEOUT), self._turn:
            await self._socket.send_text(text)

    async def send_bytes(self, data: bytes) -> None:
        async with asyncio.timeout(SEND_TIMEOUT), self._turn:
            await self._socket.send_bytes(data)


def nothing() -> None:
    """What most messages from a client mean."""


async def listen(socket: WebSocket, heard: Callable[[], None] = nothing) -> None:
    """Until the client goes; calls `heard` for each of its messages."""
    await listen_to(socket, lambda _: heard())


async def listen_to(socket: WebSocket, heard: Callable[[Mapping[str, Any]], None]) -> None:
    """Until the client goes; calls `heard` with each of its messages."""
    while (message := await socket.receive())["type"] != "websocket.disconnect":
        heard(message)


async def serve(socket: WebSocket, *work: Coroutine[Any, Any, None]) -> None:
    """Run the senders of an accepted socket until the client goes, stops reading, or the server ends."""
    try:
        await until_first_ends(*work)
    except (WebSocketDisconnect, WebSocketDisconnected):  # the second: told to a sender after the first one
        return
    except TimeoutError:
        log.info("a client of %s did not read for %g s and was dropped", socket.url.path, SEND_TIMEOUT)
    except StreamEnded:
        await goodbye(socket)


async def goodbye(socket: WebSocket, code: int = 1012, reason: str = "the server is going down") -> None:
    """Say why this is the end, unless the client has gone first."""
    try:
        async with asyncio.timeout(SEND_TIMEOUT):
            await socket.close(code, reason)
    except (TimeoutError, RuntimeError, WebSocketDisconnect):
        log.debug("a client had gone before the farewell")
