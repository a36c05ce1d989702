"""Tells other programs that a run goes on of which nothing is recorded: a recording's lock does that for the others."""

from __future__ import annotations

import contextlib
import fcntl
import os
from pathlib import Path

from server.catalogue.shelf import WALKING, file_of
from server.recording.writing.disk import OWN_FILE


class Presence:
    """An empty file, locked as long as the program lives that walks the run. Where none can be made, nothing tells."""

    def __init__(self, folder: Path, id: str) -> None:
        self._path = file_of(folder, id, WALKING)
        self._number = -1
        with contextlib.suppress(OSError):
            self._number = os.open(self._path, OWN_FILE, 0o666)
            fcntl.flock(self._number, fcntl.LOCK_EX | fcntl.LOCK_NB)

    def close(self) -> None:
        """The run is over, and the catalogue knows."""
        if self._number < 0:
            return
        with contextlib.suppress(OSError):
            self._path.unlink()
        os.close(self._number)
        self._number = -1
