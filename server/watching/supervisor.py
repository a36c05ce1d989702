"""Signs of life for systemd (sd_notify(3)): ready, alive for as long as the loop ticks, stopping."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import os
import socket
from collections.abc import Mapping

from server.watching.health import Pulse

log = logging.getLogger(__name__)

MEGA = 1_000_000
"""Microseconds of a second."""


class Supervisor:
    """Silent where nobody listens. environment: with NOTIFY_SOCKET and WATCHDOG_USEC, as systemd sets them."""

    def __init__(self, pulse: Pulse, environment: Mapping[str, str] = os.environ) -> None:
        self._pulse = pulse
        self._place = environment.get("NOTIFY_SOCKET", "")
        self._period = 0.5 * float(environment.get("WATCHDOG_USEC", "0")) / MEGA
        self._task: asyncio.Task[None] | None = None

    def start(self) -> None:
        self._say("READY=1\nSTATUS=the control loop ticks")
        if self._place and self._period > 0.0:
            self._task = asyncio.create_task(self._attend(), name="supervisor")

    async def stop(self) -> None:
        self._say("STOPPING=1")
        if self._task is not None:
            self._task.cancel()
            await asyncio.gather(self._task, return_exceptions=True)

    async def _attend(self) -> None:
        """A loop that does not tick is not vouched for, so that systemd starts the program anew."""
        while True:
            failing = self._pulse.failing
            self._say(f"STATUS={failing}" if failing else "WATCHDOG=1")
            await asyncio.sleep(self._period)

    def _say(self, words: str) -> None:
        if not self._place:
            return
        address = "\0" + self._place[1:] if self._place.startswith("@") else self._place
        with contextlib.suppress(OSError), socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as line:
            line.setblocking(False)
            line.sendto(words.encode(), address)
