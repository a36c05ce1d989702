"""A page's telemetry socket in a process of its own: reads, and says once a second that somebody can see it.

python -m tests.faults.heartbeats ORIGIN CLIENT

SIGUSR1 hides the page: it goes on reading, and says that nobody sees it.
"""

from __future__ import annotations

import contextlib
import json
import signal
import sys
import threading

from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Origin

PERIOD = 1.0
"""Between two heartbeats, s (faults.md)."""


def main(origin: str, client: str) -> None:
    hidden = threading.Event()
    signal.signal(signal.SIGUSR1, lambda *_: hidden.set())
    url = f"{origin.replace('http', 'ws', 1)}/api/v1/telemetry?client={client}"
    with connect(url, origin=Origin(origin), compression=None, proxy=None) as line:
        threading.Thread(target=_read, args=(line,), daemon=True).start()
        print("open", flush=True)
        while True:
            line.send(json.dumps({"type": "heartbeat", "visible": not hidden.is_set()}))
            threading.Event().wait(PERIOD)


def _read(line: ClientConnection) -> None:
    with contextlib.suppress(ConnectionClosed):
        for _ in line:
            pass


if __name__ == "__main__":
    with contextlib.suppress(ConnectionClosed):
        main(*sys.argv[1:])
