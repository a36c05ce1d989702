"""Records every run beside the loop: the rig hands over what happens, and never waits for a disk.

One thread writes, another makes JPEGs. What waits for them is bounded: pictures are left out when the computer is
busy, ticks never are; a disk that is too slow for them ends the recording, and with it the run.
"""

from __future__ import annotations

import threading
import time
from collections import OrderedDict
from pathlib import Path
from typing import TYPE_CHECKING

from control.model import Frame
from control.news import Announcement
from control.runs import Run
from control.safety import Refused
from control.snapshot import NOT_RECORDED, RecordingStatus, Snapshot
from server.recording.conditions import Conditions
from server.recording.writing.catalogue_row import add_figures
from server.recording.writing.disk import Disk, LocalDisk
from server.recording.writing.pictures import Encoder, FrameRate, Picture, frame_rate
from server.recording.writing.scribe import Scribe
from server.recording.writing.session import MEGA, Session, in_words
from server.recording_section import RecordingSection

if TYPE_CHECKING:
    from server.catalogue.catalogue import Catalogue

TAIL = 0.5
"""A run that is over is recorded for this long, s of rig time: the currents are seen to go (3 L/R is 0.1 s)."""
LONGEST_WAIT = 10.0
"""What waits to be written may be this old, s of rig time,"""
MOST_WAITING = 64 << 20
"""or this large, bytes."""
TICK_SIZE = 4096
"""Bytes that a waiting tick takes, about."""
PICTURE_SHARE = 8
"""A JPEG takes no more than this part of its picture: an eighth is quality 95 of a noisy one."""
START_ROOM = 20 * MEGA
"""Bytes beyond what has to stay free that a run needs to begin: half a minute of pictures."""
CLOSE_WITHIN = 2.5
"""Everything is finished after this long, s; with the coils and the sockets the program is gone within 5 s (faults.md,
row 16). What a disk has not taken by then is mended at the next start."""
REMEMBERED = 100
"""Runs whose recordings can be waited for."""


class Recorder:
    """`begin`, `tick`, `change` and `end` come from the rig's side, one after the other; `event` from anywhere.

    disk: where the next recording is written.
    """

    def __init__(
        self, folder: Path, catalogue: Catalogue, *, patient: bool = False, disk: Disk | None = None
    ) -> None:
        """folder: of the recordings.  patient: `tick` waits for room, where rig time is not the world's."""
        self.disk: Disk = disk or LocalDisk()
        self._folder = folder
        self._catalogue = catalogue
        self._patient = patient
        self._scribe = Scribe(patient=patient)
        self._encoder = Encoder(patient=patient)
        self._lock = threading.RLock()
        self._session: Session | None = None
        self._frames = FrameRate(0.0)
        self._over_at: float | None = None
        self._is_over = False
        self._finished: OrderedDict[str, threading.Event] = OrderedDict()
        self._give_up_at: float | None = None

    def start(self) -> None:
        """Start the threads now, rather than in the middle of the first run."""
        self._scribe.start()
        self._encoder.start()

    def check(self, settings: RecordingSection) -> None:
        """Whether a run can be recorded at all; raises `Refused` with what to do."""
        if not settings.enabled:
            return
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            self.disk.check(self._folder)
            free = self.disk.free(self._folder)
        except OSError as error:
            raise Refused(
                f"the run cannot be recorded: nothing can be written to {self._folder} ({in_words(error)}); mend that, "
                "choose another folder with --data, or set recording.enabled = false in the rig file"
            ) from error
        needed = settings.keep_free_MB * MEGA + START_ROOM
        if not free >= needed:
            raise Refused(
                f"the run cannot be recorded: {free / MEGA:.0f} MB are free on the disk of {self._folder}, and "
                f"{needed / MEGA:.0f} MB are needed (recording.keep_free_MB = {settings.keep_free_MB}, and "
                f"{START_ROOM / MEGA:.0f} MB to begin with); delete runs or make room"
            )

    def begin(self, run: Run, conditions: Conditions) -> None:
        """The run has just started; a recording that still waits for its last half second is finished."""
        with self._lock:
            self._finish()
            session = Session(run, conditions, self._catalogue, self._folder, self.disk)
            self._session, self._is_over, self._over_at = session, False, None
            self._frames = frame_rate(conditions.recording)
            self._remember(session)
            self._scribe.put(session.begin)
            self._scribe.while_idle = session.go_on

    def tick(self, snapshot: Snapshot, frame: Frame | None) -> None:
        """One tick and the picture that came with it."""
        with self._lock:
            session = self._session
            if session is None:
                return
            if not session.failure:
                self._hand_over(session, snapshot, frame)
            if self._is_past_tail(snapshot.time):
                self._finish()
        if self._patient and not session.failure and not self._scribe.wait_for_room(LONGEST_WAIT):
            session.give_up(
                f"the disk hangs: it has taken nothing for {LONGEST_WAIT:.0f} s; see to it, or use another one"
            )

    def event(self, line: Announcement) -> None:
        """A line of the event log."""
        with self._lock:
            session = self._session
            if session is not None and not session.failure:
                self._scribe.put(lambda: session.event(line))

    def change(self, run: Run) -> None:
        """The run goes on with another selection."""
        with self._lock:
            session = self._session
            if session is not None and session.run.id == run.id:
                self._scribe.put(lambda: session.change(run))

    def end(self, run: Run) -> None:
        """The run is over; the file is finished soon after."""
        with self._lock:
            session = self._session
            if session is None or session.run.id != run.id or self._is_over:
                return
            ended_at = session.wall_time
            self._is_over = True
            self._scribe.put(lambda: session.end(run, ended_at))
            if session.failure:
                self._finish()

    def add_figures(self, run: Run) -> None:
        """The metrics of a run that has ended without them."""
        self._scribe.put(lambda: add_figures(self._catalogue, run))

    def finish(self) -> None:
        """Whatever is recorded ends here: the rig of its ticks is about to be another one, with another clock."""
        with self._lock:
            self._finish()

    @property
    def failure(self) -> str:
        """Why the recording of the running run has ended; "" while all is well."""
        session = self._session
        return "" if session is None else session.failure

    @property
    def status(self) -> RecordingStatus:
        session = self._session
        if session is None or not session.is_kept:
            return NOT_RECORDED
        return RecordingStatus(
            state="failed" if session.failure else "recording",
            run=session.run.id,
            size=session.size,
            ticks_waiting=self._scribe.ticks_waiting,
            frames_left_out=session.frames_left_out,
            failure=session.failure,
        )

    def written(self, id: str, timeout: float) -> bool:
        """Wait until nobody here writes the recording of that run any more; False when that takes longer (s)."""
        finished = self._finished.get(id)
        return finished is None or finished.wait(timeout)

    def close(self) -> None:
        """Finish what is recorded, within 2.5 s; safe to call twice. A disk that hangs is left to itself."""
        with self._lock:
            self._finish()
            give_up = self._give_up_at = self._give_up_at or time.monotonic() + CLOSE_WITHIN
        self._scribe.close(within=max(give_up - time.monotonic(), 0.0))
        self._encoder.close(within=max(give_up - time.monotonic(), 0.1))

    # Inside --------------------------------------------------------------------------------------

    def _hand_over(self, session: Session, snapshot: Snapshot, frame: Frame | None) -> None:
        picture = self._picture(session, frame) if frame is not None else None
        size = TICK_SIZE + (frame.image.nbytes // PICTURE_SHARE if frame is not None and picture else 0)
        self._scribe.put_tick(lambda: session.tick(snapshot, picture), snapshot.time, size)
        if not self._patient:
            self._require_pace(session, snapshot.time)

    def _picture(self, session: Session, frame: Frame) -> Picture | None:
        """The frame, on its way to the encoder; None where it is not wanted or there is no room for it."""
        if not (session.is_kept and self._frames.takes(frame.captured_at)):
            return None
        picture = Picture.of(frame, lambda: self._scribe.put(session.go_on))
        if self._encoder.encode(picture, session.quality):
            return picture
        session.no_room += 1
        return None

    def _require_pace(self, session: Session, now: float) -> None:
        """End a recording whose disk does not keep up."""
        waits, size = self._scribe.waits_since(now), self._scribe.bytes_waiting
        if waits <= LONGEST_WAIT and size <= MOST_WAITING:
            return
        session.give_up(
            f"the disk is too slow: {waits:.1f} s ({size / MEGA:.0f} MB) of the run wait to be written; at most "
            f"{LONGEST_WAIT:.0f} s or {MOST_WAITING / MEGA:.0f} MB may. Use another disk, or fewer pictures "
            "(recording.frames_Hz)"
        )

    def _is_past_tail(self, now: float) -> bool:
        """Whether the run has been over for long enough. now: rig time, s."""
        if not self._is_over:
            return False
        if self._over_at is None:
            self._over_at = now
        return now - self._over_at >= TAIL

    def _finish(self) -> None:
        session, self._session = self._session, None
        if session is not None:
            self._scribe.while_idle = None
            self._scribe.put(session.finish)

    def _remember(self, session: Session) -> None:
        self._finished[session.run.id] = session.finished
        while len(self._finished) > REMEMBERED:
            self._finished.popitem(last=False)
