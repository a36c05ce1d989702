"""One recording, opened, asked for what there was at an instant."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from server.recording.clock import rig_time_of_start
from server.recording.reading.recording import Picture, Recording, Unreadable
from server.recording.reading.tick_reading import Tick
from server.recording.recovery.recount import NOTHING, number
from server.recording.tick_json import as_tick

SAME_INSTANT = 1e-6
"""Two times of one capture differ by less, s: one of them has been rounded to nanoseconds of UTC."""
NEXT_TICK = 0.02
"""A picture's own tick is not later than the one that it was written with, but for rounding; 20 ms is one tick, s."""


class Player:
    """It blocks, and is to be used from one thread at a time.

    Raises `Unreadable` where the file makes no sense.
    """

    def __init__(self, path: Path) -> None:
        self.recording = Recording.open(path)
        self.duration = self.recording.duration
        self._zero = rig_time_of_start(self.recording)

    def tick_at(self, at: float) -> dict[str, Any] | None:
        """What `GET /state` had at `at` (s since the run's start), None before the first tick."""
        messages = self.recording.tick_at(at)
        return None if messages is None else shown(messages)

    def picture_at(self, at: float) -> Picture | None:
        """The newest one at `at` or before it."""
        return self.recording.frame_at(at)

    def tick_of(self, picture: Picture) -> dict[str, Any] | None:
        """The tick that was made of this picture: it is a little older than those that follow while the picture is
        encoded, and in a fast swing the robot would stand beside itself in them."""
        for messages in self.recording.ticks(picture.captured_s, picture.time_s + NEXT_TICK):
            if self._was_made_of(messages, picture):
                return shown(messages)
        return self.tick_at(picture.time_s)

    def _was_made_of(self, messages: Mapping[str, Any], picture: Picture) -> bool:
        captured = number(messages.get("/state", NOTHING), "captured_s")
        return captured is not None and abs(captured - self._zero - picture.captured_s) < SAME_INSTANT

    def close(self) -> None:
        self.recording.close()


def shown(messages: Tick) -> dict[str, Any]:
    try:
        return as_tick(messages)
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise Unreadable(
            f"a tick of the recording is not as this pivotrig writes them ({error!r})"
        ) from error
