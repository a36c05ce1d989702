"""The recording of one run, from its beginning to its row in the catalogue. Belongs to the writing thread.

What goes wrong with the disk ends the recording, not the thread: `failure` says why, and what is readable is kept.
"""

from __future__ import annotations

import contextlib
import functools
import logging
import threading
import time
from collections import deque
from collections.abc import Iterator
from datetime import datetime, timedelta
from pathlib import Path
from typing import TYPE_CHECKING, Any

from control.news import Announcement
from control.runs import Run
from control.snapshot import Snapshot
from server.metrics_json import metrics_json
from server.recording.clock import RunClock
from server.recording.conditions import Conditions, settings_json
from server.recording.writing.catalogue_row import CatalogueRow
from server.recording.writing.disk import Disk
from server.recording.writing.overview import Overview, point_of
from server.recording.writing.pictures import Picture
from server.recording.writing.run_file import RunFile

if TYPE_CHECKING:
    from server.catalogue.catalogue import Catalogue

log = logging.getLogger(__name__)

LATE = 0.25
"""A picture that is not encoded by then is written behind later ticks, s: what waits for it would be lost with it."""
LAST_PICTURES = 1.0
"""At the end of a run its last pictures are waited for this long, s."""
MEGA = 1_000_000


class Session:
    """One run. failure: "" or why its recording has ended, in words.  finished: the file is closed, and listed."""

    def __init__(
        self, run: Run, conditions: Conditions, catalogue: Catalogue, folder: Path, disk: Disk
    ) -> None:
        self.run = run
        self.failure = ""
        self.no_room = 0
        """Pictures for which the encoder had no room; counted by the rig's side."""
        self.finished = threading.Event()
        self._conditions = conditions
        self._row = CatalogueRow(catalogue, folder, conditions)
        self._folder = folder
        self._disk = disk
        self._file: RunFile | None = None
        self._clock: RunClock | None = None
        self._overview = Overview()
        self._pending: deque[tuple[Snapshot, Picture | None]] = deque()
        self._late: list[Picture] = []
        self._early: list[Announcement] = []
        self._ended_at: datetime | None = None
        self._no_pictures = 0
        self._is_shut = False
        self._began = time.monotonic()

    @property
    def is_kept(self) -> bool:
        """Whether there is to be a file."""
        return self._conditions.recording.enabled

    @property
    def quality(self) -> int:
        """Of its pictures: JPEG's."""
        return self._conditions.recording.quality

    @property
    def frames_left_out(self) -> int:
        """Pictures that should have been recorded and are not."""
        return self.no_room + self._no_pictures

    @property
    def size(self) -> int:
        return 0 if self._file is None else self._file.size

    @property
    def wall_time(self) -> datetime:
        """Now, UTC, by the run's start and the time since then: whoever sets this computer's clock changes no run."""
        return self.run.started_at + timedelta(seconds=time.monotonic() - self._began)

    @property
    def _open_file(self) -> RunFile | None:
        """None where there is no file, or it takes nothing more: closed, or given up by its disk."""
        return None if self._is_shut else self._file

    def begin(self) -> None:
        """The file and the row."""
        with self._guarded():
            settings = settings_json(self.run, self._conditions)
            try:
                if self.is_kept:
                    self._file = self._create(settings)
            finally:
                self._row.begin(settings, has_file=self._file is not None)  # also where none can be made

    def _create(self, settings: dict[str, Any]) -> RunFile:
        keep_free = self._conditions.recording.keep_free_MB * MEGA
        return RunFile(self._folder / f"{self.run.id}.mcap", self._disk, settings, keep_free)

    def tick(self, snapshot: Snapshot, picture: Picture | None) -> None:
        """picture: that came with this tick; the tick is written once it is encoded."""
        self._pending.append((snapshot, picture))
        self.go_on()

    def go_on(self) -> None:
        """Write what is ready: ticks up to the first whose picture is still being encoded, and what is due."""
        with self._guarded():
            while self._pending and _is_ready(self._pending[0][1]):
                self._write(*self._pending.popleft())
            self._write_late_pictures()
            file = self._open_file
            if file is not None and self._clock is not None:
                file.flush_if_due()

    def event(self, line: Announcement) -> None:
        """What is told before the first tick stands behind it in the file."""
        if self._clock is None:
            self._early.append(line)
            return
        with self._guarded():
            if (file := self._open_file) is not None:
                file.event(line)

    def change(self, run: Run) -> None:
        """Another selection from here on."""
        self.run = run
        with self._guarded():
            if (file := self._open_file) is not None and self._clock is not None:
                file.select(run.request.selection)
        self._row.change(run)

    def end(self, run: Run, ended_at: datetime) -> None:
        """The run is over; its last half second is still to come."""
        self.run, self._ended_at = run, ended_at
        self._row.end(run, ended_at)

    def finish(self) -> None:
        """The end of the file; afterwards it is whole, or as whole as the disk allows."""
        try:
            self._wait_for_pictures()
            complete = self._close_file()
            self._is_shut = True
            self._row.finish(self.run, self._ended_at, self._of_file(complete))
        finally:
            self.finished.set()

    def give_up(self, why: str) -> None:
        """End the recording, keeping what is readable. From any thread."""
        self.failure = self.failure or why

    # Inside --------------------------------------------------------------------------------------

    def _write(self, snapshot: Snapshot, picture: Picture | None) -> None:
        clock = self._clock or self._begin_at(snapshot)
        self._overview.add(clock.since_start(snapshot.time), functools.partial(point_of, snapshot))
        file = self._open_file
        if file is None:
            return
        file.tick(snapshot)
        while self._early:
            file.event(self._early.pop(0))
        if picture is None:
            return
        if picture.is_done:
            self._write_picture(picture)
        else:
            self._late.append(picture)

    def _begin_at(self, first: Snapshot) -> RunClock:
        """The first tick tells what the rig's clock showed when the run began."""
        run = first.run
        elapsed = run.elapsed if run is not None and run.id == self.run.id else 0.0
        clock = self._clock = RunClock(self.run.started_at, first.time - elapsed)
        if self._file is not None:
            self._file.begin(clock, self.run.request.selection, self._conditions.camera_model)
        return clock

    def _write_picture(self, picture: Picture) -> None:
        file = self._open_file
        if file is not None and picture.jpeg:
            file.picture(picture)
        else:
            self._no_pictures += 1

    def _write_late_pictures(self) -> None:
        while self._late and self._late[0].is_done:
            self._write_picture(self._late.pop(0))

    def _wait_for_pictures(self) -> None:
        give_up = time.monotonic() + LAST_PICTURES
        while (self._pending or self._late) and time.monotonic() < give_up and not self._is_shut:
            self.go_on()
            time.sleep(0.005)
        while self._pending:
            with self._guarded():
                self._write(*self._pending.popleft())
        self._no_pictures += len(self._late)
        self._late.clear()

    def _close_file(self) -> bool:
        """Whether the file has its end."""
        file = self._file
        if file is None:
            return False
        with self._guarded(), contextlib.closing(file):
            file.finish(self._outcome(file), self._overview.as_json())
            return True
        return False

    def _outcome(self, file: RunFile) -> dict[str, Any]:
        run = self.run
        return {
            "state": run.state.value,
            "reason": run.reason,
            "metrics": None if run.metrics is None else metrics_json(run.metrics),
            "ended_at": None if self._ended_at is None else self._ended_at.isoformat(),
            "ticks": file.ticks,
            "frames": file.frames,
            "frames_left_out": self.frames_left_out,
            "failure": self.failure,
        }

    def _of_file(self, complete: bool) -> dict[str, Any]:
        found: dict[str, Any] = {"sparkline": self._overview.sparkline()}
        if self._file is not None:
            state = "complete" if complete else "recovered"  # readable, though it lacks its end
            found |= {"size_bytes": self._file.size, "frames": self._file.frames, "recording_state": state}
        return found

    @contextlib.contextmanager
    def _guarded(self) -> Iterator[None]:
        """An error of the disk ends the recording; so does a mistake in here, which may be anywhere."""
        try:
            yield
        except OSError as error:
            log.error("the recording of run %s ends: %s", self.run.id, in_words(error))
            self._is_shut = True
            self.give_up(in_words(error))
        except Exception as error:
            log.exception("the recording of run %s ends", self.run.id)
            self._is_shut = True
            self.give_up(f"the recorder has a mistake ({error!r})")


def _is_ready(picture: Picture | None) -> bool:
    return picture is None or picture.is_done or time.monotonic() - picture.asked_at > LATE


def in_words(error: OSError) -> str:
    """Why a disk has not done what it was asked for."""
    return error.strerror or str(error)
