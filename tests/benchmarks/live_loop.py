"""The loop in real time: frame-in to bytes-out, and whether it keeps 60 Hz with a dashboard attached."""

from __future__ import annotations

import asyncio
import time

from tests.benchmarks.served import get, post, served, with_one_dashboard

WALK = 20.0
"""Seconds; twice what the loop's own figures look back on."""


def report() -> None:
    print("\nlive loop at 640x480, 60 Hz, walking the eight (10 s of ticks behind each row)")
    print(
        f"{'clients':24} {'rate Hz':>8} {'period p99':>11} {'latency p50':>12} {'latency p99':>12} {'dropped':>8}"
    )
    with served() as address:
        _start_walking(address)
        time.sleep(0.6 * WALK)
        alone = _row("none (reference)", address)
        asyncio.run(with_one_dashboard(address, 0.6 * WALK))
        watched = _row("one dashboard", address)
    print(f"p99 with a dashboard over p99 without: {watched / alone:.2f}")


def _start_walking(address: str) -> None:
    until = time.monotonic() + 20.0
    while get(address, "/state")["tracking"] != "locked":
        if time.monotonic() > until:
            raise RuntimeError("the robot was not found")
        time.sleep(0.1)
    time.sleep(0.5)
    post(address, "/arm")
    post(address, "/runs", {"gait": {"sweep_deg": 10.0}})


def _row(name: str, address: str) -> float:
    loop = get(address, "/state")["loop"]
    print(
        f"{name:24} {loop['rate_Hz']:8.2f} {loop['period_p99_ms']:8.2f} ms {loop['latency_p50_ms']:9.2f} ms "
        f"{loop['latency_p99_ms']:9.2f} ms {loop['dropped_frames']:8d}"
    )
    return loop["latency_p99_ms"]
