"""A stream lasts no longer than the token or session that opened it."""

from __future__ import annotations

from starlette.types import Message, Send

from server.access.guard import Admitted

ENDED = 1008


class AccessEnded(Exception):
    """The token or session of a stream has ended while it went on."""


def while_still(admitted: Admitted, send: Send) -> Send:
    """A send that raises `AccessEnded` once the caller is no longer admitted; what was sent before stands."""

    async def send_while_still(message: Message) -> None:
        if message.get("more_body", False) and not admitted.still():
            await send({"type": "http.response.body", "body": b"", "more_body": False})
            raise AccessEnded
        await send(message)

    return send_while_still


def closing_unless_still(admitted: Admitted, send: Send) -> Send:
    """The same for a WebSocket, which is told that it is over."""

    async def send_while_still(message: Message) -> None:
        if message["type"] == "websocket.send" and not admitted.still():
            await send({"type": "websocket.close", "code": ENDED, "reason": "the token or session has ended"})
            raise AccessEnded
        await send(message)

    return send_while_still
