"""A recording played as if it were a camera: at its own pace or as fast as it is read, once or for ever."""

from __future__ import annotations

import math
import threading
import time
from collections import deque
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from control.model import CameraNote, Frame
from vision.sources.live import NOTES_KEPT
from vision.sources.request import CameraError, Size

LONGEST_SKIP = 0.1
"""Frames that nobody fetched are left out for this long at a time, s; a film that is behind its own pace even then
goes on from where it is, as if it had stood still meanwhile."""


@dataclass(frozen=True, slots=True)
class Still:
    """One frame of a film. time: since its beginning, s.  index: 0 for the first."""

    time: float
    index: int


class Film(Protocol):
    """Pictures in their order. name: what it is called in words.  damaged: pictures left out so far."""

    name: str
    identity: str
    size: Size
    rate: float
    damaged: int

    def advance(self) -> Still | None:
        """On to the next picture; None at the end."""
        ...

    def picture(self) -> NDArray[np.uint8] | None:
        """The one that `advance` has come to; None when it is damaged."""
        ...

    def rewind(self) -> None: ...

    def close(self) -> None: ...


class RecordedCamera:
    """Satisfies the loop's camera protocol; frames whose time has passed are left out, as by a camera.

    fast: the clock goes with the film, a frame at each reading.  loop: from the beginning again at the end.
    """

    simulated = False

    def __init__(self, film: Film, *, fast: bool = False, loop: bool = False) -> None:
        self.size = film.size
        self.rate = film.rate
        self.identity = film.identity
        self.trouble = ""
        """Why there are no more frames."""
        self._film = film
        self._fast = fast
        self._loop = loop
        self._start = math.nan
        self._fast_now = time.monotonic()
        self._ahead: Still | None = None
        self._last: Still | None = None
        self._shown = 0
        """Frames of the rounds before this one."""
        self._told_damaged = 0
        self._notes: deque[CameraNote] = deque(maxlen=NOTES_KEPT)
        self._closing = threading.Event()
        self._using = threading.Lock()

    def now(self) -> float:
        return self._fast_now if self._fast else time.monotonic()

    def require(self) -> None:
        """A recording is there, or it could not have been opened."""

    def read(self, timeout: float) -> Frame | None:
        """The next frame at its time; None when that is further off than `timeout`, s, when the picture is
        damaged, or at the end."""
        with self._using:
            if self._closing.is_set():
                return None
            now = self.now()
            still = self._upcoming(now)
            due = math.inf if still is None else self._start + still.time
            self._wait(min(due, now + timeout), at_the_end=still is None)
            if still is None or due > now + timeout or self._closing.is_set():
                return None
            self._ahead = None
            image = self._picture()
            return None if image is None else Frame(image, due, self._shown + still.index)

    def take_notes(self) -> list[CameraNote]:
        """What was wrong with the recording since the last call, oldest first."""
        return [self._notes.popleft() for _ in range(len(self._notes))]

    def close(self) -> None:
        self._closing.set()
        with self._using:
            self._film.close()

    def _upcoming(self, now: float) -> Still | None:
        """The next frame whose successor is not due yet; None when the film has ended."""
        if math.isnan(self._start):
            self._start = now
        give_up = time.monotonic() + LONGEST_SKIP
        while self._ahead is None or now >= self._start + self._ahead.time + 1.0 / self.rate:
            if self._ahead is not None and time.monotonic() > give_up:
                self._start = now - self._ahead.time
                break
            self._ahead = self._film.advance()
            self._count_damaged()
            if self._ahead is None and not self._begin_again():
                return None
            self._last = self._ahead or self._last
        return self._ahead

    def _begin_again(self) -> bool:
        """From the first picture, which follows the last one in time; False when there is nothing to repeat."""
        if not self._loop or self._last is None:
            self.trouble = self.trouble or f"{self._film.name} has ended"
            return False
        try:
            self._film.rewind()
        except CameraError as error:
            self._last, self.trouble = None, str(error)
            return False
        self._start += self._last.time + 1.0 / self.rate
        self._shown += self._last.index + 1
        self._last = None
        return True

    def _wait(self, until: float, *, at_the_end: bool) -> None:
        if self._fast and not at_the_end:
            self._fast_now = max(self._fast_now, until)
            return
        self._closing.wait(max(0.0, until - self.now()))
        self._fast_now = max(self._fast_now, until)

    def _picture(self) -> NDArray[np.uint8] | None:
        image = self._film.picture()
        self._count_damaged()
        return image

    def _count_damaged(self) -> None:
        """Told whenever it has doubled: a film in a loop comes by its damage again and again."""
        damaged = self._film.damaged
        if damaged >= max(1, 2 * self._told_damaged):
            self._told_damaged = damaged
            words = f"{self._film.name} is damaged: {damaged} of its pictures could not be used so far"
            self._notes.append(CameraNote("warn", words))
