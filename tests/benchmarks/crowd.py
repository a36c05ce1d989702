"""How the loop keeps its pace while a lab looks on: 30 dashboards' telemetry, 5 cameras, 3 scenes and 5 who never read.

Lateness: the 99th percentile of the time between two ticks, less the camera's period; lost: frames that found the loop
busy. The clients run in a process of their own, on the same two cores.
"""

from __future__ import annotations

import asyncio
import contextlib
import json
import multiprocessing
import socket
import tempfile
import time
from pathlib import Path
from urllib.parse import urlsplit

import websockets

from tests.benchmarks.clients import watch_camera, watch_scene, watch_telemetry
from tests.processes import Server, served

LOOK = 20.0
"""Time behind each row, s."""
SETTLE = 3.0
"""Until all clients are there, s."""

PERIOD = 1e3 / 60.0
"""Of the simulated camera, ms."""

Crowd = dict[str, int]
NOBODY: Crowd = {}
LAB: Crowd = {"telemetry": 30, "camera": 5, "scene": 3, "never read": 5}
MANY: Crowd = {"telemetry": 100}


async def never_read(address: str) -> None:
    """A telemetry client that is connected and takes nothing; it comes again when it has been dropped."""
    parts = urlsplit(address)
    assert parts.hostname is not None
    words = (
        f"GET /api/v1/telemetry HTTP/1.1\r\nHost: {parts.netloc}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
    )
    while True:
        line = socket.create_connection((parts.hostname, parts.port or 80))
        with line:
            line.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            line.sendall(words.encode())
            await asyncio.sleep(10.0)


WATCH = {"telemetry": watch_telemetry, "camera": watch_camera, "scene": watch_scene, "never read": never_read}


def attend(address: str, crowd: Crowd, seconds: float) -> None:
    """In a process of its own: the crowd looks on."""
    asyncio.run(attending(address, crowd, seconds))


async def attending(address: str, crowd: Crowd, seconds: float) -> None:
    tasks = [
        asyncio.create_task(WATCH[kind](address)) for kind, number in crowd.items() for _ in range(number)
    ]
    await asyncio.wait(tasks, timeout=seconds)
    for task in tasks:
        task.cancel()
    await asyncio.gather(*tasks, return_exceptions=True)


def report() -> None:
    print("\ncrowd: the loop's pace while a lab looks on, the robot walking")
    print(f"{'clients':44} {'loop Hz':>8} {'late p99':>9} {'latency p99':>12} {'lost':>5} {'client Hz':>10}")
    with tempfile.TemporaryDirectory() as data, served(Path(data), "--sim") as server:
        server.start_walking()
        time.sleep(SETTLE)
        alone = row("none (reference)", server, NOBODY)
        watched = row("30 telemetry, 5 cameras, 3 scenes, 5 deaf", server, LAB)
        row("100 telemetry", server, MANY)
    print(f"p99 latency with the lab over without: {watched / alone:.2f}")


def row(name: str, server: Server, crowd: Crowd) -> float:
    """Prints the figures; the answer is the latency at the 99th percentile, ms."""
    process = multiprocessing.get_context("spawn").Process(
        target=attend, args=(server.address, crowd, SETTLE + LOOK)
    )
    process.start()
    time.sleep(SETTLE)
    before = server.get("/state")["loop"]["dropped_frames"]
    heard = asyncio.run(heard_rate(server.address, LOOK - SETTLE))
    state = server.get("/state")
    process.join()
    loop = state["loop"]
    late = loop["period_p99_ms"] - PERIOD
    print(
        f"{name:44} {loop['rate_Hz']:8.2f} {late:6.2f} ms {loop['latency_p99_ms']:9.2f} ms "
        f"{loop['dropped_frames'] - before:5d} {heard:10.1f}  {state['rig']}"
    )
    return loop["latency_p99_ms"]


async def heard_rate(address: str, seconds: float) -> float:
    """Ticks a second of one more client, who reads."""
    count, end = 0, time.monotonic() + seconds
    async with websockets.connect(address.replace("http", "ws") + "/api/v1/telemetry", max_size=None) as line:
        while (left := end - time.monotonic()) > 0:
            with contextlib.suppress(TimeoutError):
                message = await asyncio.wait_for(line.recv(), left)
                count += json.loads(message)["type"] == "tick"
    return count / seconds
