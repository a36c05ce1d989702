"""The loop in real time: frame-in to bytes-out, and whether it keeps 60 Hz with a dashboard attached."""

from __future__ import annotations

import asyncio
import tempfile
import time
from pathlib import Path

from tests.benchmarks.clients import with_one_dashboard
from tests.processes import Server, served

WALK = 12.0
"""Seconds; a little more than the loop's own figures look back on."""


def report() -> None:
    print("\nlive loop at 640x480, 60 Hz, walking the eight (10 s of ticks behind each row)")
    print(
        f"{'clients':24} {'rate Hz':>8} {'period p99':>11} {'latency p50':>12} {'latency p99':>12} {'dropped':>8}"
    )
    with tempfile.TemporaryDirectory() as data, served(Path(data), "--sim") as server:
        server.start_walking()
        time.sleep(WALK)
        alone = _row("none (reference)", server)
        asyncio.run(with_one_dashboard(server.address, WALK))
        watched = _row("one dashboard", server)
    print(f"p99 with a dashboard over p99 without: {watched / alone:.2f}")


def _row(name: str, server: Server) -> float:
    loop = server.get("/state")["loop"]
    print(
        f"{name:24} {loop['rate_Hz']:8.2f} {loop['period_p99_ms']:8.2f} ms {loop['latency_p50_ms']:9.2f} ms "
        f"{loop['latency_p99_ms']:9.2f} ms {loop['dropped_frames']:8d}"
    )
    return loop["latency_p99_ms"]
