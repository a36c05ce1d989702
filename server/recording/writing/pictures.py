"""Which camera pictures are recorded, and the thread that makes JPEGs of them."""

from __future__ import annotations

import contextlib
import logging
import math
import queue
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass

from control.model import Frame
from server.recording_section import RecordingSection
from vision.encoding import encode_jpeg

log = logging.getLogger(__name__)

WAITING = 4
"""Pictures that may wait for the encoder: 4 MB of 640 x 480, and longer than any burst of work takes."""
PATIENCE = 10.0
"""Where a picture waits for room, it waits no longer than this, s."""


class FrameRate:
    """Chooses evenly among the pictures that come: so many a second, by their capture times."""

    def __init__(self, rate: float) -> None:
        """rate: Hz; 0 for none."""
        self._period = 1.0 / rate if rate > 0.0 else math.inf
        self._due = -math.inf

    def takes(self, captured_at: float) -> bool:
        """Whether to record a picture of this capture time, s.

        Half a period of tolerance: a camera at about this rate loses no picture to its own jitter.
        """
        if not (math.isfinite(self._period) and math.isfinite(captured_at)):
            return False
        if self._due - 2.0 * self._period < captured_at < self._due - 0.5 * self._period:
            return False  # before that lies more than a period: a stamp was wrong, and is not waited for
        self._due = max(self._due + self._period, captured_at + 0.5 * self._period)
        return True


@dataclass(slots=True)
class Picture:
    """One to be recorded. jpeg: empty until it is encoded, and for good where that failed.

    frame: None once it is encoded, which frees its memory.  captured_at: rig time, s.  index: the frame's.
    asked_at: `time.monotonic` when it was handed in, s.  tell: called by the encoder when it is done.
    """

    frame: Frame | None
    captured_at: float
    index: int
    asked_at: float
    tell: Callable[[], None]
    jpeg: bytes = b""
    is_done: bool = False

    @classmethod
    def of(cls, frame: Frame, tell: Callable[[], None]) -> Picture:
        return cls(frame, frame.captured_at, frame.index, time.monotonic(), tell)

    def encode(self, quality: int) -> None:
        """Whatever a camera may have sent: a picture that is none stays empty."""
        try:
            self.jpeg = encode_jpeg(self.frame.image, quality) if self.frame is not None else b""
        except Exception:
            log.exception("picture %d cannot be recorded", self.index)
        self.frame, self.is_done = None, True
        self.tell()


class Encoder:
    """The thread; started by the first picture."""

    def __init__(self, *, patient: bool) -> None:
        """patient: a picture waits for room instead of being left out."""
        self._patient = patient
        self._waiting: queue.Queue[tuple[Picture, int] | None] = queue.Queue(maxsize=WAITING)
        self._thread: threading.Thread | None = None

    def start(self) -> None:
        """Start the thread, if it is not there yet."""
        if self._thread is None:
            self._thread = threading.Thread(target=self._work, name="recorder's encoder", daemon=True)
            self._thread.start()

    def encode(self, picture: Picture, quality: int) -> bool:
        """False when there is no room for it. quality: JPEG's, 1..100."""
        self.start()
        try:
            self._waiting.put((picture, quality), self._patient, PATIENCE)
        except queue.Full:
            return False
        return True

    def close(self, within: float) -> None:
        """Finish what waits. within: s."""
        if self._thread is None:
            return
        with contextlib.suppress(queue.Full):
            self._waiting.put(None, timeout=within)
            self._thread.join(within)

    def _work(self) -> None:
        while (job := self._waiting.get()) is not None:
            picture, quality = job
            picture.encode(quality)


def frame_rate(settings: RecordingSection) -> FrameRate:
    return FrameRate(settings.frames_Hz if settings.enabled else 0.0)
