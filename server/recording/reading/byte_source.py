"""The bytes of a file that nobody vouches for: every read is checked against what is really there."""

from __future__ import annotations

import os
from pathlib import Path
from types import TracebackType

WINDOW = 1 << 18
"""What is read ahead where small pieces are asked for one after the other, bytes."""


class Damaged(Exception):
    """These bytes are not what their place says; the message says in words what is wrong."""


class ByteSource:
    """A file opened for reading. size: when it was opened, bytes; what is appended later is not seen.

    Reads are at a place, not at a position, so that several iterators may share one source.
    Raises OSError when the file cannot be opened.
    """

    def __init__(self, path: Path) -> None:
        self._handle = os.open(path, os.O_RDONLY | os.O_CLOEXEC)
        self.size = os.fstat(self._handle).st_size
        self._window = b""
        self._window_at = 0

    def read(self, offset: int, length: int) -> bytes:
        """Exactly these bytes; raises `Damaged` where the file has not that many, before any memory is taken."""
        if not (min(offset, length) >= 0 and offset + length <= self.size):
            raise Damaged(f"{length} bytes at {offset} reach past the end of the file at {self.size}")
        inside = offset - self._window_at
        if 0 <= inside <= len(self._window) - length:
            return self._window[inside : inside + length]
        if length > WINDOW // 4:
            return self._read(offset, length)
        self._window, self._window_at = b"", offset
        self._window = self._read(offset, min(WINDOW, self.size - offset))
        return self._window[:length]

    def _read(self, offset: int, length: int) -> bytes:
        pieces: list[bytes] = []
        while length > 0:
            piece = self._piece(offset, length)
            pieces.append(piece)
            offset, length = offset + len(piece), length - len(piece)
        return b"".join(pieces)

    def _piece(self, offset: int, length: int) -> bytes:
        if self._handle < 0:
            raise ValueError("the recording has been closed")
        try:
            piece = os.pread(self._handle, length, offset)
        except OSError as error:
            raise Damaged(f"the disk does not give the bytes at {offset}: {error.strerror}") from error
        if not piece:
            raise Damaged(f"the file has become shorter than {offset + length} bytes")
        return piece

    def fileno(self) -> int:
        return self._handle

    def close(self) -> None:
        if self._handle >= 0:
            os.close(self._handle)
            self._handle = -1

    def __enter__(self) -> ByteSource:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
