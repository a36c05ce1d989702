"""A serial device whose writes are judged by what it took, not by the clock.

pyserial gives up when its time is over even though every byte has been taken: on a computer that had no time for the
program for that long, a port that works would be called jammed.
"""

from __future__ import annotations

import os
import select
import time
from typing import Any

import serial
from serial.serialutil import SerialTimeoutException


class Device:
    """An open port (without blocking, as pyserial opens it); `patience`: how long a jammed one is waited for, s."""

    def __init__(self, port: serial.Serial, patience: float) -> None:
        self._port = port
        self._patience = patience

    @property
    def in_waiting(self) -> int:
        return self._port.in_waiting

    @property
    def out_waiting(self) -> int:
        return self._port.out_waiting

    def read(self, size: int = 1, /) -> bytes:
        return self._port.read(size)

    def write(self, b: Any, /) -> int:
        """All of it; SerialTimeoutException when the port still has no room at the end of its patience."""
        rest = bytes(b)
        until = time.monotonic() + self._patience
        while True:
            is_over = time.monotonic() >= until
            rest = rest[self._taken(rest) :]
            if not rest:
                return len(b)
            if is_over:
                raise SerialTimeoutException("Write timeout")
            select.select([], [self._port], [], max(0.0, until - time.monotonic()))

    def _taken(self, data: bytes) -> int:
        try:
            return os.write(self._port.fileno(), data)
        except BlockingIOError:
            return 0

    def reset_output_buffer(self) -> None:
        self._port.reset_output_buffer()

    def close(self) -> None:
        self._port.close()
