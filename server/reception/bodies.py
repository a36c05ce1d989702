"""Bodies and messages, counted while they come: a stream need not announce its length."""

from __future__ import annotations

from starlette.types import Message, Receive, Send


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
    """A receive that ends the connection with 1009 when a message is longer than `limit` bytes."""

    async def receive_capped() -> Message:
        message = await receive()
        text, data = message.get("text") or "", message.get("bytes") or b""
        if message["type"] != "websocket.receive" or max(len(text), len(data)) <= limit:
            return message
        await send({"type": "websocket.close", "code": 1009, "reason": f"at most {limit} bytes a message"})
        return {"type": "websocket.disconnect", "code": 1009}

    return receive_capped
