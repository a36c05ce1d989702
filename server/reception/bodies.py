"""Bodies and messages, counted while they come: a stream need not announce its length."""

from __future__ import annotations

import time

from starlette.types import Message, Receive, Send

MESSAGES = 200.0
"""WebSocket messages a second that one client may send; the busiest honest one, a scene that is turned, sends 60."""
BURST = 400.0
"""Messages that may come at once, as after a pause of the network."""


async def read_body(receive: Receive, limit: int) -> tuple[bytes, bool]:
    """The body as far as `limit` bytes, and whether that is all of it."""
    chunks: list[bytes] = []
    size = 0
    while True:
        message = await receive()
        chunk = message.get("body", b"")
        size += len(chunk)
        if size > limit:
            return b"", False
        chunks.append(chunk)
        if message["type"] != "http.request" or not message.get("more_body", False):
            return b"".join(chunks), True


def replaying(body: bytes, receive: Receive) -> Receive:
    """A receive that gives the body that has been read, then whatever comes after it."""
    first: list[Message] = [{"type": "http.request", "body": body, "more_body": False}]

    async def replay() -> Message:
        return first.pop() if first else await receive()

    return replay


def capped(receive: Receive, send: Send, limit: int) -> Receive:
    """A receive that ends the connection when a message is longer than `limit` bytes (1009), or when they come faster
    than anybody can mean them (1008)."""
    allowance, since = BURST, time.monotonic()

    async def refuse(code: int, reason: str) -> Message:
        await send({"type": "websocket.close", "code": code, "reason": reason})
        return {"type": "websocket.disconnect", "code": code}

    async def receive_capped() -> Message:
        nonlocal allowance, since
        message = await receive()
        if message["type"] != "websocket.receive":
            return message
        now = time.monotonic()
        allowance, since = min(BURST, allowance + (now - since) * MESSAGES) - 1.0, now
        if allowance < 0.0:
            return await refuse(1008, f"at most {MESSAGES:g} messages a second")
        text, data = message.get("text") or "", message.get("bytes") or b""
        if max(len(text), len(data)) > limit:
            return await refuse(1009, f"at most {limit} bytes a message")
        return message

    return receive_capped
