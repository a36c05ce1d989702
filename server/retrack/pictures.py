"""The recorded pictures, each at the tick at which the rig looked at it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from control.model import Frame
from server.exports.run_film import in_order
from server.recording.reading.recording import Picture, Recording
from server.retrack.recorded_tick import RecordedTick
from vision.film import decode_jpeg

SAME = 1e-6
"""Two times that are closer are one: those of the file are whole nanoseconds, s."""


class RecordedPictures:
    """Ask for each tick in turn. taken: pictures handed out."""

    def __init__(self, recording: Recording) -> None:
        self._pictures: Iterator[Picture] = in_order(recording.frames())
        self._next = next(self._pictures, None)
        self.taken = 0

    def at(self, tick: RecordedTick) -> Frame | None:
        """The picture that belongs to this tick; one whose own tick is lost is handed out with the next."""
        picture = None
        while self._next is not None and self._next.time_s <= tick.since_start + SAME:
            picture, self._next = self._next, next(self._pictures, None)
        image = None if picture is None else decode_jpeg(picture.jpeg)
        if picture is None or image is None:
            return None
        self.taken += 1
        return Frame(np.asarray(image, np.uint8), _captured_at(picture, tick), tick.number)


def _captured_at(picture: Picture, tick: RecordedTick) -> float:
    """Rig time, s: with every digit where the tick has it."""
    captured = picture.captured_s + tick.time - tick.since_start
    if tick.captured_at is not None and abs(captured - tick.captured_at) <= SAME:
        return tick.captured_at
    return captured
