"""The client that sees everything in a soak: each tick and event of the telemetry goes through the live rules."""

from __future__ import annotations

import json
import threading
import time
from collections import deque
from collections.abc import Callable
from typing import Any

from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from tests.soak.broken import InvariantBroken
from tests.soak.live_rules import LiveRules

KEPT = 300
"""Events for whoever wants to know what happened before an invariant broke."""
SILENCE = 6.0
"""The telemetry says something at least so often, s: a clock each second, but for a loop that hangs."""


class Watcher:
    """events: the newest ones.  broken: what a rule has said first."""

    def __init__(self, address: str, rules: LiveRules, asked: Callable[[], float]) -> None:
        """asked: when the operator last asked for current, monotonic, s."""
        self.rules = rules
        self.events: deque[dict[str, Any]] = deque(maxlen=KEPT)
        self.broken: AssertionError | None = None
        self._asked = asked
        self._guard = threading.Lock()
        self._ending = False
        url = f"{address.replace('http', 'ws', 1)}/api/v1/telemetry"
        self._line = connect(url, max_size=None, proxy=None, additional_headers={"X-Client": "soak watcher"})
        self._thread = threading.Thread(target=self._watch, name="watcher")
        self._thread.start()

    def close(self) -> None:
        self._ending = True
        self._line.close()
        self._thread.join()

    def expect_the_end(self) -> None:
        """The server is about to go."""
        self._ending = True

    def begin(self, names: frozenset[str]) -> None:
        with self._guard:
            self.rules.begin(names)

    def end(self) -> None:
        with self._guard:
            self.rules.end()

    def check(self) -> None:
        """Raises what has been broken."""
        if self.broken is not None:
            raise self.broken

    def _watch(self) -> None:
        try:
            while True:
                self._heed(json.loads(self._line.recv(timeout=SILENCE)))
        except AssertionError as broken:
            self.broken = broken
        except TimeoutError:
            self.broken = InvariantBroken(f"I6: the telemetry was silent for {SILENCE:g} s")
        except ConnectionClosed as closed:
            if not self._ending:
                self.broken = InvariantBroken(f"the telemetry has ended: {closed}")

    def _heed(self, message: dict[str, Any]) -> None:
        with self._guard:
            if message["type"] == "tick":
                self.rules.tick(message, time.monotonic(), self._asked())
            elif message["type"] == "event":
                event = message.get("event", message)
                self.events.append(event)
                self.rules.event(event)
