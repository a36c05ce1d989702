"""A camera that goes on by itself: its own thread keeps the newest picture, and opens it anew when it goes away."""

from __future__ import annotations

import logging
import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from control.model import CameraNote, Frame
from vision.sources.request import CameraError, CameraRequest, Size, in_words

log = logging.getLogger(__name__)

FIRST_BACK_OFF = 0.2
LONGEST_BACK_OFF = 2.0
"""Waits between attempts to open a camera that went away, s; each is twice the one before."""
OPENING_TIME = 5.0
"""A camera may take so long to open, s: slow ones start within 3."""
CLOSING_TIME = 2.0
"""A reader that is inside the driver gets this long to come back, s."""
NOTES_KEPT = 50
"""Notes that wait for somebody to take them."""
SAY_AGAIN = 10.0
"""The same words are said again after this time, s, and not before: a loose cable fills no event log."""


@dataclass(frozen=True, slots=True)
class Picture:
    """image: (height, width, 3) BGR uint8.  captured_at: monotonic, s; as good as the source knows it."""

    image: NDArray[np.uint8]
    captured_at: float


class Source(Protocol):
    """An open camera, in the hands of one thread. ignored: what it does otherwise than asked, in words."""

    identity: str
    size: Size
    ignored: tuple[str, ...]

    def read(self) -> Picture | None:
        """Waits for the next picture; None for a damaged one. Raises `CameraError` when there are no more."""
        ...

    def close(self) -> None: ...


Opener = Callable[[], Source]
"""Opens the camera; raises `CameraError`. May take its time, and may hang."""


class LiveCamera:
    """Satisfies the loop's camera protocol. Only the reader's thread ever touches driver or decoder, so one that
    hangs keeps nobody waiting; a camera that went away is looked for with growing waits, and `read` returns None."""

    simulated = False

    def __init__(self, opener: Opener, name: str, request: CameraRequest) -> None:
        """name: as it may be shown."""
        self.size = request.size
        self.rate = request.rate
        self.identity = ""
        """Of the camera that was opened last; "" until one could be."""
        self._opener = opener
        self._name = name
        self._latency = request.latency
        self._newest: Frame | None = None
        self._index = 0
        self._trouble = f"camera {name} is being opened"
        self._tried = False
        self._notes: deque[CameraNote] = deque(maxlen=NOTES_KEPT)
        self._said_at: dict[str, float] = {}
        self._change = threading.Condition()
        self._closing = threading.Event()
        self._reader = threading.Thread(target=self._run, name=f"camera {name}", daemon=True)
        self._reader.start()

    @property
    def trouble(self) -> str:
        """Why there are no pictures, "" while the camera is open."""
        return self._trouble

    def now(self) -> float:
        return time.monotonic()

    def require(self) -> None:
        """Returns once the camera is open; raises `CameraError` when the first attempt fails or takes too long."""
        with self._change:
            self._change.wait_for(lambda: self._tried or self._closing.is_set(), OPENING_TIME)
        if not self._tried:
            raise CameraError(f"camera {self._name} has not answered for {OPENING_TIME:g} s; connect it anew")
        if self._trouble:
            raise CameraError(self._trouble)

    def read(self, timeout: float) -> Frame | None:
        """The newest frame that has not been read yet; None when none came within `timeout`, s."""
        with self._change:
            self._change.wait_for(lambda: self._newest is not None or self._closing.is_set(), timeout)
            frame, self._newest = self._newest, None
        return None if self._closing.is_set() else frame

    def take_notes(self) -> list[CameraNote]:
        """What happened to the camera since the last call, oldest first."""
        return [self._notes.popleft() for _ in range(len(self._notes))]

    def close(self) -> None:
        """A driver that hangs is left to itself: its thread ends when it comes back, or with the program."""
        if self._closing.is_set():
            return
        self._closing.set()
        with self._change:
            self._change.notify_all()
        self._reader.join(CLOSING_TIME)
        if self._reader.is_alive():
            log.warning("camera %s has not let go within %g s; its driver hangs", self._name, CLOSING_TIME)

    # On the reader's thread ----------------------------------------------------------------------

    def _run(self) -> None:
        back_off = FIRST_BACK_OFF
        while not self._closing.is_set():
            frames = self._index
            try:
                self._follow(self._open())
            except CameraError as error:
                self._miss(str(error))
            except Exception as error:  # noqa: BLE001 (whatever a driver or decoder does, it is tried again)
                self._miss(f"camera {self._name} has failed: {error}")
            if self._index > frames:
                back_off = FIRST_BACK_OFF
            self._closing.wait(back_off)
            back_off = min(2.0 * back_off, LONGEST_BACK_OFF)

    def _open(self) -> Source:
        source = self._opener()
        if source.size != self.size:
            source.close()
            raise CameraError(
                f"camera {self._name} gives {in_words(source.size)} where {in_words(self.size)} was asked; "
                "set camera.size_px to a size that it offers"
            )
        return source

    def _follow(self, source: Source) -> None:
        """Keep the newest picture until the camera goes away or is closed."""
        try:
            self._welcome(source)
            while not self._closing.is_set():
                picture = source.read()
                if picture is not None:
                    self._deliver(picture)
        finally:
            source.close()

    def _welcome(self, source: Source) -> None:
        """Tell what the camera does not do as asked, and that it is back."""
        if self._tried and self._trouble:
            self._say("info", f"camera {self._name} is there ({source.identity})")
        for words in source.ignored:
            self._say("warn", f"camera {self._name}: {words}")
        self.identity = source.identity
        self._report("")

    def _miss(self, reason: str) -> None:
        if reason != self._trouble and not self._closing.is_set():
            self._say("warn", f"{reason}; looking for it again")
        self._report(reason)

    def _say(self, severity: str, words: str) -> None:
        now = time.monotonic()
        self._said_at = {said: at for said, at in self._said_at.items() if now - at < SAY_AGAIN}
        if words not in self._said_at:
            self._notes.append(CameraNote(severity, words))
            self._said_at[words] = now

    def _report(self, trouble: str) -> None:
        with self._change:
            self._trouble, self._tried = trouble, True
            self._change.notify_all()

    def _deliver(self, picture: Picture) -> None:
        with self._change:
            self._newest = Frame(picture.image, picture.captured_at - self._latency, self._index)
            self._index += 1
            self._change.notify_all()
