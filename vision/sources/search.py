"""Looks for cameras where nobody waits: asking one means opening it, and a driver may hang in that."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Future

from vision.sources.listing import FoundCamera, find_cameras


class CameraSearch:
    """One search at a time, on a thread of its own: a driver that hangs keeps that one, and no second."""

    def __init__(self, find: Callable[[], list[FoundCamera]] = find_cameras) -> None:
        self._find = find
        self._lock = threading.Lock()
        self._search: Future[list[FoundCamera]] | None = None

    def begin(self) -> Future[list[FoundCamera]]:
        """The search that goes on, or else a new one; from any thread."""
        with self._lock:
            if self._search is None or self._search.done():
                self._search = Future()
                threading.Thread(
                    target=self._run, args=(self._search,), name="camera search", daemon=True
                ).start()
            return self._search

    def _run(self, search: Future[list[FoundCamera]]) -> None:
        try:
            search.set_result(self._find())
        except Exception as error:  # noqa: BLE001 (told to whoever waits for it)
            search.set_exception(error)
