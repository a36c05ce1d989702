"""One dashboard's worth of protocol clients: telemetry, camera and scene."""

from __future__ import annotations

import asyncio

import viser
import websockets
from websockets.typing import Subprotocol


async def watch_telemetry(address: str) -> None:
    async with websockets.connect(f"{_socket(address)}/api/v1/telemetry", max_size=None) as socket:
        async for _ in socket:
            pass


async def watch_camera(address: str) -> None:
    async with websockets.connect(f"{_socket(address)}/api/v1/camera?view=raw", max_size=None) as socket:
        async for _ in socket:
            await socket.send("ok")


async def watch_scene(address: str) -> None:
    protocol = Subprotocol(f"viser-v{viser.__version__}")
    async with websockets.connect(
        f"{_socket(address)}/scene", subprotocols=[protocol], max_size=None, compression=None
    ) as socket:
        async for _ in socket:
            pass


def _socket(address: str) -> str:
    return address.replace("http://", "ws://")


async def with_one_dashboard(address: str, duration: float) -> None:
    """Telemetry, camera and scene clients look on for `duration` seconds."""
    watchers = [asyncio.create_task(watch(address)) for watch in (watch_telemetry, watch_camera, watch_scene)]
    done, _ = await asyncio.wait(watchers, timeout=duration, return_when=asyncio.FIRST_COMPLETED)
    for watcher in watchers:
        watcher.cancel()
    for watcher in done:
        watcher.result()
        raise RuntimeError("a client was disconnected")
