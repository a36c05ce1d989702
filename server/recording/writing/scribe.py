"""The thread that writes: jobs go in from anywhere and are done one after the other."""

from __future__ import annotations

import logging
import queue
import threading
from collections.abc import Callable
from dataclasses import dataclass

log = logging.getLogger(__name__)

Job = Callable[[], None]

IDLE = 0.1
"""With nothing to do, what is due is looked after this often, s."""
ROOM = 120
"""Ticks that may wait where a tick waits for room: 2 s of rig time."""


@dataclass(frozen=True, slots=True)
class Tick:
    """A job that is counted. time: rig time, s.  size: bytes that it takes while it waits."""

    job: Job
    time: float
    size: int


class Scribe:
    """Started by the first job. What waits is counted by two counters each, of which either side writes one."""

    def __init__(self, *, patient: bool) -> None:
        self._jobs: queue.SimpleQueue[Job | Tick | None] = queue.SimpleQueue()
        self._thread: threading.Thread | None = None
        self._patient = patient
        self._room = threading.Condition()
        self._put = self._done = 0
        self._put_size = self._done_size = 0
        self._doing_since: float | None = None
        self._is_closed = False
        self.while_idle: Job | None = None
        """Done again and again while nothing else is there to do."""

    @property
    def ticks_waiting(self) -> int:
        return self._put - self._done

    @property
    def bytes_waiting(self) -> int:
        return self._put_size - self._done_size

    def waits_since(self, now: float) -> float:
        """How long the tick that is being written has been waiting, rig time, s; 0 when none is."""
        since = self._doing_since
        return now - since if since is not None and self._put > self._done else 0.0

    def put(self, job: Job) -> None:
        self.start()
        self._jobs.put(job)

    def put_tick(self, job: Job, time: float, size: int) -> None:
        self.start()
        if self._put == self._done:
            self._doing_since = time
        self._put += 1
        self._put_size += size
        self._jobs.put(Tick(job, time, size))

    def wait_for_room(self, within: float) -> bool:
        """False when there is none after so many seconds."""
        with self._room:
            return self._room.wait_for(lambda: self.ticks_waiting < ROOM or self._is_closed, within)

    def close(self, within: float) -> bool:
        """Do what waits, and end the thread; False when it does not come back within so many seconds."""
        self._is_closed = True
        if self._thread is None:
            return True
        self._jobs.put(None)
        self._thread.join(within)
        return not self._thread.is_alive()

    def start(self) -> None:
        """Start the thread, if it is not there yet."""
        if self._thread is None:
            self._thread = threading.Thread(target=self._work, name="recorder's writer", daemon=True)
            self._thread.start()

    def _work(self) -> None:
        while (job := self._next()) is not None:
            if isinstance(job, Tick):
                self._doing_since = job.time
                _do(job.job)
                self._note_done(job)
            else:
                _do(job)

    def _next(self) -> Job | Tick | None:
        try:
            return self._jobs.get(timeout=IDLE if self.while_idle is not None else None)
        except queue.Empty:
            return self.while_idle or _nothing

    def _note_done(self, tick: Tick) -> None:
        self._done += 1
        self._done_size += tick.size
        if self._patient:
            with self._room:
                self._room.notify_all()


def _nothing() -> None:
    """What there is to do when the last recording has just ended."""


def _do(job: Job) -> None:
    try:
        job()
    except Exception:  # a mistake in one job must not end the thread that all others need
        log.exception("the recorder failed")
