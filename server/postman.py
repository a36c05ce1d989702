"""Sends notifications from a thread of its own, one after the other, so that nobody ever waits for the other side."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from server.webhook import Call, NotDelivered

WAITING = 20
"""Messages that may wait; what comes on top of them is lost, and told."""
PAUSES = (1.0, 5.0, 25.0)
"""Before each further attempt, s: a phone network's gap is over by then, and old news are none."""
LEAVING = 1.0
"""At the end what goes on is broken off, and gets this long to notice, s."""

Body = Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Letter:
    """url: where to.  timeout: of one attempt, s."""

    url: str
    timeout: float
    body: Body


class Postman:
    """tell: is told, on the postman's thread, of what could not be delivered; once until something can."""

    def __init__(self, tell: Callable[[str], None], pauses: tuple[float, ...] = PAUSES) -> None:
        self._tell = tell
        self._pauses = pauses
        self._letters: queue.Queue[Letter] = queue.Queue(WAITING)
        self._ending = threading.Event()
        self._call: Call | None = None
        self._failing = False
        self._thread: threading.Thread | None = None

    def send(self, letter: Letter) -> None:
        """To be delivered soon. Never waits; what does not fit is lost, and told."""
        if self._ending.is_set():
            return
        if self._thread is None:
            self._thread = threading.Thread(target=self._run, name="notifications", daemon=True)
            self._thread.start()
        try:
            self._letters.put_nowait(letter)
        except queue.Full:
            self._complain(f"more than {WAITING} notifications wait to be sent; the newest are lost")

    def close(self) -> None:
        """Break off what goes on, forget what waits; blocks for a moment."""
        self._ending.set()
        if (call := self._call) is not None:
            call.break_off()
        if self._thread is not None:
            self._thread.join(LEAVING)

    def _run(self) -> None:
        while not self._ending.is_set():
            try:
                letter = self._letters.get(timeout=0.2)
            except queue.Empty:
                continue
            self._deliver(letter)

    def _deliver(self, letter: Letter) -> None:
        reason = ""
        for pause in (0.0, *self._pauses):
            if self._ending.wait(pause):
                return
            try:
                self._attempt(letter)
            except NotDelivered as error:
                reason = str(error)
            else:
                self._failing = False
                return
        if not self._ending.is_set():
            self._complain(
                f"a notification could not be sent to the webhook, {len(self._pauses) + 1} times: {reason}"
            )

    def _attempt(self, letter: Letter) -> None:
        self._call = Call(letter.url, letter.timeout)
        try:
            self._call.post(letter.body)
        finally:
            self._call = None

    def _complain(self, words: str) -> None:
        if not self._failing:
            self._failing = True
            self._tell(words)
