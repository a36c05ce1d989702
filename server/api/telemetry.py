"""The live state for everybody who watches: newest only for each client, and every event."""

from __future__ import annotations

import asyncio
from typing import Annotated

from fastapi import APIRouter, Query, WebSocket

from server.api.access import TheRig, TheTickText
from server.api.sockets import Line, listen, serve
from server.api.ticks import TickText, text
from server.streams import Cadence

router = APIRouter(tags=["telemetry"])

FASTEST = 30.0
"""Ticks a second that a client gets at most; more than a person sees."""

Rate = Annotated[float, Query(gt=0.0, le=FASTEST, allow_inf_nan=False)]


@router.websocket("/telemetry")
async def telemetry(socket: WebSocket, rig: TheRig, tick_text: TheTickText, rate_Hz: Rate = FASTEST) -> None:
    """Ticks at `rate_Hz` or less, and runs, events and changes of the selection as they come."""
    await socket.accept()
    line = Line(socket)
    await serve(
        socket, listen(socket), send_ticks(line, rig, tick_text, 1.0 / rate_Hz), send_announcements(line, rig)
    )


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
