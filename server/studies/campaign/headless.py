"""A campaign without a server: the machine is ticked as fast as it goes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from datetime import UTC, datetime
from typing import TYPE_CHECKING, TypeVar

from control.link.conversion import LinkError
from control.loop import ControlLoop
from control.runs import Run, RunRequest, RunState
from control.snapshot import Snapshot
from server.headless import FRAME_TIMEOUT, INTERRUPTED, Watch
from server.run_list import new_id
from server.run_recording import RunRecording
from server.studies.campaign.operator import RigGone
from vision.sources.opening import CameraError

if TYPE_CHECKING:
    from server.assembly import Machine
    from server.occupation import Occupant
    from server.recording.writing.recorder import Recorder

T = TypeVar("T")


class HeadlessOperator:
    """Opens a machine and closes it. A person has agreed that it is armed; nobody comes to arm it after a fault.

    watch: told of every tick.
    """

    may_arm = True
    is_attended = False

    def __init__(self, machine: Machine, recorder: Recorder, watch: Watch | None = None) -> None:
        self._machine = machine
        self._loop = machine.loop
        self._watch = watch
        self._recording = RunRecording(recorder)
        self._run: Run | None = None

    @property
    def now(self) -> float:
        return self._machine.camera.now()

    @contextmanager
    def occupied(self, by: Occupant) -> Iterator[None]:  # noqa: ARG002 (there is nobody else)
        """The machine is open meanwhile. Raises `RigGone` where it cannot be."""
        try:
            self._machine.open()
            yield
        except (CameraError, LinkError, OSError) as error:
            raise RigGone(f"the rig cannot be used: {error}") from error
        finally:
            self._close()

    def tick(self) -> Snapshot:
        frame = self._machine.camera.read(FRAME_TIMEOUT)
        self._recording.heed(self._loop)
        snapshot = self._recording.keep(self._loop.tick(frame, self.now), frame)
        self._heed_news()
        if self._watch is not None:
            self._watch(snapshot)
        return snapshot

    def do(self, act: Callable[[ControlLoop], T]) -> T:
        return act(self._loop)

    def check_disk(self) -> None:
        self._recording.check(self._machine)

    def start(self, request: RunRequest, permit: Callable[[], None]) -> str:
        self.check_disk()
        permit()
        run = Run(new_id(), request, RunState.RUNNING, datetime.now(UTC))
        self._loop.start(run.id, request)
        self._recording.begin(self._machine, run)
        self._run = run
        return run.id

    def outcome(self, id: str) -> Run:
        run = self._run
        if run is None or run.id != id:
            raise KeyError(f"the newest run is not {id!r}")
        return run

    def is_recorded(self, id: str) -> bool:
        return self._recording.is_complete(id)

    def _heed_news(self) -> None:
        for line in self._loop.take_announcements():
            self._recording.tell(line)
        for ended in self._loop.take_ended():
            self._recording.end(ended)
            if self._run is not None and self._run.id == ended.id:
                self._run = replace(self._run, state=ended.state, reason=ended.reason, metrics=ended.metrics)

    def _close(self) -> None:
        """A run that was interrupted ends, with zero current, and its recording says so."""
        try:
            self._loop.abort_run("ended", INTERRUPTED)
            self._heed_news()
            self._recording.leave()
        finally:
            self._machine.close()
