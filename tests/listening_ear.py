"""A real HTTP server on loopback that hears notifications, refuses them, or does not answer."""

from __future__ import annotations

import contextlib
import json
import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

PATIENCE = 10.0


class Ear(ThreadingHTTPServer):
    """heard: the bodies that came.  answers: the next statuses; then 204.  mute: nothing is answered."""

    daemon_threads = True

    def __init__(self) -> None:
        super().__init__(("127.0.0.1", 0), Handler)
        self.heard: list[dict[str, Any]] = []
        self.answers: list[int] = []
        self.mute = threading.Event()
        self.ending = threading.Event()
        self._came = threading.Condition()

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self.server_address[1]}/hooks/key-of-the-lab?room=7"

    def take(self, body: dict[str, Any]) -> None:
        with self._came:
            self.heard.append(body)
            self._came.notify_all()

    def wait_for(self, number: int) -> list[dict[str, Any]]:
        """What was heard, once there are so many."""
        with self._came:
            assert self._came.wait_for(lambda: len(self.heard) >= number, PATIENCE), self.heard
            return list(self.heard)


class Handler(BaseHTTPRequestHandler):
    @property
    def ear(self) -> Ear:
        assert isinstance(self.server, Ear)
        return self.server

    def do_POST(self) -> None:
        body = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        self.ear.take({**body, "path": self.path, "type": self.headers["Content-Type"]})
        if self.ear.mute.is_set():
            self.ear.ending.wait(PATIENCE)
            return
        self.send_response(self.ear.answers.pop(0) if self.ear.answers else 204)
        self.send_header("Location", "http://127.0.0.1:1/elsewhere")
        self.send_header("Content-Length", "0")
        self.end_headers()

    def log_message(self, format: str, *args: Any) -> None:
        """Nothing: what was heard is asked for."""


@contextlib.contextmanager
def listening() -> Iterator[Ear]:
    with Ear() as ear:
        thread = threading.Thread(target=ear.serve_forever, kwargs={"poll_interval": 0.02})
        thread.start()
        try:
            yield ear
        finally:
            ear.ending.set()
            ear.shutdown()
            thread.join()
