"""One run without a browser: the same loop, as fast as it goes when the rig is simulated."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import TYPE_CHECKING

from control.news import Ended
from control.runs import Run, RunRequest, RunState
from control.safety import Refused
from control.snapshot import RigState, Snapshot
from server.assembly import Machine
from server.run_recording import RunRecording

if TYPE_CHECKING:
    from server.recording.writing.recorder import Recorder

FRAME_TIMEOUT = 0.034
"""As in `server.rig_life`, s."""
READY_WITHIN = 5.0
"""Camera, track and board must be there after this long, s of rig time."""
INTERRUPTED = "the program was ended"
"""Why a run ends that goes on when the program does."""


@dataclass(frozen=True, slots=True)
class HeadlessRun:
    """A finished run. wall: real seconds.  simulated: rig seconds, start-up included."""

    ended: Ended
    wall: float
    simulated: float


Watch = Callable[[Snapshot], None]
"""Told of every tick, for progress and for tests that compare with the truth."""


def run_headless(
    machine: Machine, id: str, request: RunRequest, watch: Watch | None = None, *, consent: bool = False
) -> HeadlessRun:
    """Arm, walk, disarm, and keep nothing but the figures. Raises `Refused` when the rig does not get ready or a
    fault ends the run.

    consent: a person agrees that current flows, without which a real rig does not arm.
    """
    return Headless(machine, watch).run(id, request, consent=consent)


class Headless:
    """Drives one machine through one run, and closes it. recorder: keeps the run; None: nobody does."""

    def __init__(
        self, machine: Machine, watch: Watch | None = None, recorder: Recorder | None = None
    ) -> None:
        self._machine = machine
        self._loop = machine.loop
        self._watch = watch
        self._recording = RunRecording(recorder)

    def run(self, id: str, request: RunRequest, *, consent: bool = False) -> HeadlessRun:
        """As `run_headless`; also raises `Refused` where the run could not be recorded."""
        started, begin = time.perf_counter(), self._machine.camera.now()
        try:
            self._machine.open()
            self._recording.check(self._machine)
            self._until_ready()
            self._loop.arm(request.selection.gait, consent=consent)
            self._loop.start(id, request)
            self._recording.begin(self._machine, Run(id, request, RunState.RUNNING, datetime.now(UTC)))
            ended = self._walk()
            self._loop.disarm("run finished")
            self._tick()
            return HeadlessRun(ended, time.perf_counter() - started, self._machine.camera.now() - begin)
        finally:
            self._close()

    def _close(self) -> None:
        """A run that was interrupted ends, with zero current, and its recording says so."""
        try:
            self._loop.abort_run("ended", INTERRUPTED)
            self._heed_news()
        finally:
            self._machine.close()

    def _tick(self) -> Snapshot:
        frame = self._machine.camera.read(FRAME_TIMEOUT)
        self._recording.heed(self._loop)
        snapshot = self._recording.keep(self._loop.tick(frame, self._machine.camera.now()), frame)
        if self._watch is not None:
            self._watch(snapshot)
        return snapshot

    def _heed_news(self) -> list[Ended]:
        for line in self._loop.take_announcements():
            self._recording.tell(line)
        ended = self._loop.take_ended()
        for each in ended:
            self._recording.end(each)
        return ended

    def _until_ready(self) -> None:
        give_up = self._machine.camera.now() + READY_WITHIN
        while True:
            self._tick()
            obstacle = self._loop.obstacle
            if not obstacle:
                return
            if self._machine.camera.now() > give_up:
                raise Refused(f"the rig is not ready: {obstacle}")

    def _walk(self) -> Ended:
        while True:
            snapshot = self._tick()
            for ended in self._heed_news():
                if ended.state is RunState.ABORTED:
                    raise Refused(f"the run was aborted: {ended.reason}")
                return ended
            if snapshot.rig is RigState.HELD:
                reason = f"the run was held: {snapshot.reason}"
                self._loop.abort_run("held", reason)
                raise Refused(reason)
