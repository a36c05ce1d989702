"""A real `pivotrig serve` process for as long as somebody needs it, and a dashboard's worth of clients."""

from __future__ import annotations

import asyncio
import json
import subprocess
import sys
import tempfile
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import viser
import websockets
from websockets.typing import Subprotocol


@contextmanager
def served(*arguments: str) -> Iterator[str]:
    """The address of a dashboard of the simulated rig."""
    with tempfile.TemporaryDirectory() as data:
        command = [
            sys.executable,
            "-m",
            "server",
            "serve",
            "--sim",
            "--port",
            "0",
            "--data",
            data,
            *arguments,
        ]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        try:
            assert process.stdout is not None
            line = process.stdout.readline()
            if not line.startswith("dashboard: "):
                raise RuntimeError(f"the server did not start: {line!r}")
            yield line.removeprefix("dashboard: ").strip()
        finally:
            process.terminate()
            process.wait(10)


def get(address: str, path: str) -> Any:
    with urllib.request.urlopen(f"{address}/api/v1{path}", timeout=10) as answer:
        return json.load(answer)


def post(address: str, path: str, body: dict[str, Any] | None = None) -> Any:
    request = urllib.request.Request(
        f"{address}/api/v1{path}",
        data=json.dumps(body or {}).encode(),
        headers={"Content-Type": "application/json"},
        method="POST",
    )
    with urllib.request.urlopen(request, timeout=10) as answer:
        return json.load(answer)


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
