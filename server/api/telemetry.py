"""The live state for everybody who watches: newest only for each client, and every event."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Mapping
from typing import Annotated, Any

from fastapi import APIRouter, FastAPI, Query, WebSocket

from server.access.caller import Caller, TheCaller
from server.api.access import TheRig, TheTickText
from server.api.body import parse
from server.api.operator import TheLease
from server.api.sockets import Line, listen_to, serve
from server.api.state import VERSION
from server.api.ticks import TickText, text
from server.lease.desk import LeaseDesk
from server.streams import Cadence

router = APIRouter(tags=["telemetry"])

FASTEST = 30.0
"""Ticks a second that a client gets at most; more than a person sees."""

CLOCK_PERIOD = 1.0
"""How often a client is told the time, s, by which it finds out how late everything comes."""

Rate = Annotated[float, Query(gt=0.0, le=FASTEST, allow_inf_nan=False)]


@router.websocket("/telemetry")
async def telemetry(
    socket: WebSocket,
    rig: TheRig,
    tick_text: TheTickText,
    lease: TheLease,
    caller: TheCaller,
    rate_Hz: Rate = FASTEST,
) -> None:
    """Who the server is, ticks at `rate_Hz` or less, and runs, events, changes of the selection and of who operates
    the rig as they come.

    An operator stays one while it is heard: a page by `{"type": "heartbeat", "visible": true}` once a second, a
    script by any message, as long as it reads what it is sent.
    """
    first = text({**await greeting(socket.app), **lease.you(caller)})
    await socket.accept()
    line = Line(socket)
    await serve(
        socket,
        listen_to(socket, lambda message: heard(message, lease, caller)),
        greet(line, first, lease),
        send_ticks(line, rig, tick_text, 1.0 / rate_Hz),
        send_announcements(line, rig),
    )


def heard(message: Mapping[str, Any], lease: LeaseDesk, caller: Caller) -> None:
    """A script lives while it says anything, a page while it says that somebody can see it."""
    if not caller.from_page or is_visible(message.get("text") or ""):
        lease.hear(caller)


def is_visible(said: str) -> bool:
    try:
        value = parse(said.encode())
    except ValueError:
        return False
    return isinstance(value, dict) and value.get("type") == "heartbeat" and value.get("visible") is True


async def greet(line: Line, first: str, lease: LeaseDesk) -> None:
    """The server's first words, before which nothing else is sent, who operates, then the time again and again."""
    await line.send_text(first)
    await line.send_text(text({"type": "operator", **lease.public()}))
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
