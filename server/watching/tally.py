"""What only grows, counted as it happens: ticks, states and events of the rig, and what clients have asked for."""

from __future__ import annotations

import math
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from control.snapshot import Snapshot

CODES = 200
"""Kinds of events that are told apart; the program knows some fifty."""
OTHER = "other"


class RigTally:
    """Follows the rig tick by tick, on its thread. last_at: of the newest tick, monotonic, s."""

    def __init__(self) -> None:
        self.ticks = 0
        self.last_at = -math.inf
        self.entered: Counter[str] = Counter()
        self._state: str | None = None

    def follow(self, snapshot: Snapshot) -> None:
        self.ticks += 1
        self.last_at = time.monotonic()
        state = snapshot.rig.value
        if state != self._state:
            self._state = state
            self.entered[state] += 1


class EventTally:
    def __init__(self) -> None:
        self.events: Counter[tuple[str, str]] = Counter()

    def add(self, severity: str, code: str) -> None:
        key = (severity, code)
        self.events[key if key in self.events or len(self.events) < CODES else (severity, OTHER)] += 1


class ClientTally:
    """requests: by the class of their answer.  open: what is open, by its kind."""

    def __init__(self) -> None:
        self.requests: Counter[str] = Counter()
        self.open: Counter[str] = Counter()

    @contextmanager
    def counted(self, kind: str) -> Iterator[None]:
        self.open[kind] += 1
        try:
            yield
        finally:
            self.open[kind] -= 1


class Counting:
    """An ASGI layer that fills a `ClientTally`."""

    def __init__(self, app: ASGIApp, tally: ClientTally) -> None:
        self._app = app
        self._tally = tally

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return

        async def send_counted(message: Message) -> None:
            if message["type"] == "http.response.start":
                self._tally.requests[f"{message['status'] // 100}xx"] += 1
            await send(message)

        with self._tally.counted(kind_of(scope)):
            await self._app(scope, receive, send_counted)


def kind_of(scope: Scope) -> str:
    """Of what is open, from a handful of kinds."""
    if scope["type"] == "http":
        return "mjpeg" if scope["path"].endswith("/stream.mjpg") else "request"
    path: str = scope["path"]
    if path.startswith("/scene"):
        return "scene"
    return (
        path.rsplit("/", 1)[-1]
        if path in ("/api/v1/telemetry", "/api/v1/camera", "/api/v1/replay")
        else OTHER
    )


KINDS = ("telemetry", "camera", "mjpeg", "scene", "replay", "request", OTHER)
