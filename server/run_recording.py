"""The rig's side of the recorder: hands over what happens, and ends a run that cannot be recorded any more.

Belongs to the rig's thread. Whatever the recorder does, the rig goes on; only a run that must be recorded stops.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from control.loop import ControlLoop
from control.model import Frame
from control.news import Announcement, Ended
from control.runs import Run, RunState, Selection
from control.snapshot import NOT_RECORDED, RecordingStatus, Snapshot
from server.recording.conditions import conditions_of
from server.recording.writing.disk_answer import DiskAnswer

if TYPE_CHECKING:
    from server.assembly import Machine
    from server.recording.writing.recorder import Recorder

log = logging.getLogger(__name__)

CODE = "recording"
"""Of the lines in the event log."""
FRAMES_LEFT_OUT = (
    "the computer is too busy to keep every picture: some are left out of the recording, ticks never are; fewer "
    "pictures (recording.frames_Hz) take less of it"
)


class RunRecording:
    """recorder: None where nothing is recorded, not even that there was a run."""

    def __init__(self, recorder: Recorder | None) -> None:
        self._recorder = recorder
        self._disk_answer = DiskAnswer()
        self._run: Run | None = None
        self._hung: Run | None = None
        """A run that has ended while the loop did not answer: its figures may come later."""
        self._is_kept = False
        self._broken = ""
        self._frames_told = False
        self._lost: RecordingStatus | None = None

    def start(self) -> None:
        """The rig is opened: the recorder gets ready."""
        self._hand_over(lambda recorder: recorder.start())

    def check(self, machine: Machine) -> None:
        """Before anything moves; raises `Refused` where the run could not be recorded. Blocks for some seconds where
        a disk does not answer."""
        recorder, settings = self._recorder, machine.settings.recording
        if recorder is None:
            return
        recorder.disk = machine.disk
        self._disk_answer.wait_for(lambda: recorder.check(settings))

    def begin(self, machine: Machine, run: Run) -> None:
        self._frames_told = False
        self._run, self._broken, self._lost = run, "", None
        self._is_kept = machine.settings.recording.enabled
        self._hand_over(lambda recorder: recorder.begin(run, conditions_of(machine)))

    def change(self, selection: Selection) -> None:
        """The run goes on with another selection."""
        if self._run is None:
            return
        run = self._run = replace(self._run, request=replace(self._run.request, selection=selection))
        self._hand_over(lambda recorder: recorder.change(run))

    def heed(self, loop: ControlLoop) -> None:
        """End a run of which nothing is kept any more, and say so once when pictures are left out."""
        if self._run is not None and self._status.frames_left_out and not self._frames_told:
            self._frames_told = True
            loop.announce("warn", CODE, FRAMES_LEFT_OUT)
        if self._run is not None and self._is_kept and self._failure:
            self._lost = replace(self._status, state="failed", failure=self._failure)
            loop.abort_run(CODE, f"the run was ended since its recording has failed: {self._failure}")

    def keep(self, snapshot: Snapshot, frame: Frame | None) -> Snapshot:
        """Hand over one tick; the same with the recording's own state."""
        self._hand_over(lambda recorder: recorder.tick(snapshot, frame))
        status = self._status
        return snapshot if status is NOT_RECORDED else replace(snapshot, recording=status)

    def tell(self, line: Announcement) -> None:
        """A line of the event log; from any thread."""
        self._hand_over(lambda recorder: recorder.event(line))

    def end(self, ended: Ended) -> None:
        if self._run is not None and self._run.id == ended.id:
            self._end(replace(self._run, state=ended.state, reason=ended.reason, metrics=ended.metrics))
        elif self._hung is not None and self._hung.id == ended.id:
            late = replace(self._hung, metrics=ended.metrics)
            self._hung = None
            self._hand_over(lambda recorder: recorder.add_figures(late))

    def abort(self, reason: str) -> None:
        """The rig's thread hangs; from another one."""
        if self._run is not None:
            self._hung = replace(self._run, state=RunState.ABORTED, reason=reason)
            self._end(self._hung)

    def is_complete(self, id: str) -> bool:
        """Whether recording and catalogue have all that there will be of a run; from any thread."""
        return self._recorder is None or self._recorder.written(id, 0.0)

    def leave(self) -> None:
        """The rig becomes another one; what is still recorded of the last run ends with this one."""
        self._hand_over(lambda recorder: recorder.finish())

    def _end(self, run: Run) -> None:
        """A recorder with a mistake is asked all the same, for what it has; it is told of no more ticks."""
        self._run = None
        broken, self._broken = self._broken, ""
        self._hand_over(lambda recorder: recorder.end(run))
        if broken:
            self._hand_over(lambda recorder: recorder.finish())
        self._broken = broken or self._broken

    @property
    def _failure(self) -> str:
        return self._broken or ("" if self._recorder is None else self._recorder.failure)

    @property
    def _status(self) -> RecordingStatus:
        """What became of a recording that has failed is told until the next run begins."""
        if self._recorder is None:
            return NOT_RECORDED
        return self._lost or self._recorder.status

    def _hand_over(self, step: Callable[[Recorder], None]) -> None:
        if self._recorder is None or self._broken:
            return
        try:
            step(self._recorder)
        except Exception as error:
            log.exception("the recorder failed; nothing more is recorded of this run")
            self._broken = f"the recorder has a mistake ({error!r})"
