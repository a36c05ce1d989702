"""A tap on the serial line between a server and a board that is a process of its own.

The server opens the tap's terminal as its port; every message is written down with the monotonic time at which
it passed.
"""

from __future__ import annotations

import os
import pty
import select
import threading
import time
import tty
from dataclasses import dataclass

from control.link import wire
from control.link.messages import Message

LOOK = 0.05
"""Seconds after which the tap looks whether it is to end."""


@dataclass(frozen=True, slots=True)
class Passed:
    """A message of the host's, and when it passed, s (monotonic)."""

    at: float
    message: Message


class WireTap:
    """Carries bytes both ways between `name` and the board's terminal until it is closed."""

    def __init__(self, board_port: str) -> None:
        self.heard: list[Passed] = []
        self._near, self._far = pty.openpty()
        tty.setraw(self._far)
        self.name = os.ttyname(self._far)
        self._board = os.open(board_port, os.O_RDWR | os.O_NOCTTY)
        tty.setraw(self._board)
        self._decoder = wire.Decoder()
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._carry, name="wire tap")
        self._thread.start()

    def close(self) -> None:
        self._ending.set()
        self._thread.join()
        for end in (self._near, self._far, self._board):
            os.close(end)

    def _carry(self) -> None:
        while not self._ending.is_set():
            ready, _, _ = select.select([self._near, self._board], [], [], LOOK)
            if self._near in ready:
                self._from_host(os.read(self._near, 4096))
            if self._board in ready:
                os.write(self._near, os.read(self._board, 4096))

    def _from_host(self, data: bytes) -> None:
        now = time.monotonic()
        os.write(self._board, data)
        self.heard += [Passed(now, packet.message) for packet in self._decoder.feed(data)]

    def first(self, kind: type[Message], since: float) -> float | None:
        """When the first message of a kind passed after `since`."""
        return next((p.at for p in self.heard if p.at >= since and isinstance(p.message, kind)), None)
