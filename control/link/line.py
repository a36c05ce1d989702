"""What the link needs of a serial line: a pyserial port has it, and so has everything that is put before one."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol


class SerialLine(Protocol):
    """An open line; every verb may raise OSError when the line fails, `write` SerialTimeoutException when it is
    jammed."""

    @property
    def in_waiting(self) -> int: ...
    @property
    def out_waiting(self) -> int: ...
    def read(self, size: int = 1, /) -> bytes: ...
    def write(self, b: Any, /) -> int | None: ...
    def reset_output_buffer(self) -> None: ...
    def close(self) -> None: ...


Wrap = Callable[[SerialLine], SerialLine]
"""Puts something before a line that has just been opened; may raise OSError as opening does."""
