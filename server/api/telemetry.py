"""The live state for everybody who watches: newest only for each client, and every event."""

from __future__ import annotations

import asyncio
import time
from typing import Annotated, Any

from fastapi import APIRouter, FastAPI, Query, WebSocket

from server.api.access import TheRig, TheTickText
from server.api.sockets import Line, listen, serve
from server.api.state import VERSION
from server.api.ticks import TickText, text
from server.streams import Cadence

router = APIRouter(tags=["telemetry"])

FASTEST = 30.0
"""Ticks a second that a client gets at most; more than a person sees."""

CLOCK_PERIOD = 1.0
"""How often a client is told the time, s, by which it finds out how late everything comes."""

Rate = Annotated[float, Query(gt=0.0, le=FASTEST, allow_inf_nan=False)]


@router.websocket("/telemetry")
async def telemetry(socket: WebSocket, rig: TheRig, tick_text: TheTickText, rate_Hz: Rate = FASTEST) -> None:
    """Who the server is, ticks at `rate_Hz` or less, and runs, events and changes of the selection as they come."""
    first = text(await greeting(socket.app))
    await socket.accept()
    line = Line(socket)
    await serve(
        socket,
        listen(socket),
        greet(line, first),
        send_ticks(line, rig, tick_text, 1.0 / rate_Hz),
        send_announcements(line, rig),
    )


async def greet(line: Line, first: str) -> None:
    """The server's first words, before which nothing else is sent, then the time again and again."""
    await line.send_text(first)
    while True:
        await line.send_text(text({"type": "clock", "server_s": round(time.monotonic(), 3)}))
        await asyncio.sleep(CLOCK_PERIOD)


async def greeting(app: FastAPI) -> dict[str, Any]:
    """page: the files that a page is made from now.  start: of this program, another one after each restart."""
    page = await app.state.page_files.version()
    return {"type": "server", "version": VERSION, "page": page.stamp, "start": app.state.start}


async def send_ticks(line: Line, rig: TheRig, tick_text: TickText, period: float) -> None:
    cadence = Cadence(period, asyncio.get_running_loop().time, asyncio.sleep)
    async with rig.updates.subscribe() as snapshots:
        while True:
            await cadence.wait()
            await line.send_text(tick_text.of(await snapshots.get()))


async def send_announcements(line: Line, rig: TheRig) -> None:
    async with rig.announcements.subscribe() as announcements:
        while True:
            await line.send_text(text(await announcements.get()))
