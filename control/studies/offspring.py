"""Worker processes end with the one that started them. Loads nothing else: it holds from their first instant."""

from __future__ import annotations

import os
import signal
import threading
import time

LOOK = 0.5
"""How often a worker looks whether its parent lives, s."""


def stay_with(parent: int) -> None:
    """In a worker: end when the parent has ended, however it did; leave Ctrl-C to it. parent: its number."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_watch, args=(parent,), name="parent", daemon=True).start()


def _watch(parent: int) -> None:
    while os.getppid() == parent:
        time.sleep(LOOK)
    os._exit(1)
