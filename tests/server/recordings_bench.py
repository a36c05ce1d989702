"""Recordings for tests, made fast: a robot that walks a circle, written by the real recorder.

bench = RecordingsBench()                       # one tick of the simulated rig, as the pattern for all others
id = bench.record(data_folder, duration=10.0)   # the file and its row in the catalogue are there
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np

from control.gait import Counts
from control.metrics import MetricsTally
from control.model import Frame, Pose
from control.news import Announcement
from control.runs import Choice, Run, RunRequest, RunState, Selection
from control.snapshot import RigState, RunProgress, Snapshot
from server.archive import Archive
from server.assembly import build_machine
from server.recording.conditions import Conditions, conditions_of
from server.recording.writing.recorder import TAIL
from server.settings import RigFile

RADIUS, PERIOD = 20e-3, 60.0
"""Of the circle: m and s for one round."""
ERROR = 1e-3
"""By how much the robot is outside of it on average, m."""
ZERO = 100.0
"""Rig time at which the run begins, s."""
LENGTH = 10e-3
"""Between the pivots, m."""
FINISH_WITHIN = 30.0
STARTED = datetime(2026, 3, 1, 12, 0, 0, 123456, tzinfo=UTC)


@dataclass(frozen=True)
class Walk:
    """What to record. duration: s.  rate: ticks, Hz.  frame_rate: pictures, Hz of rig time, 0 for none.

    index: sets id and date, a minute apart.  trajectory: what the settings say; the robot walks a circle.
    """

    duration: float = 5.0
    rate: float = 60.0
    frame_rate: float = 10.0
    index: int = 0
    label: str = ""
    tags: tuple[str, ...] = ()
    trajectory: str = "eight"

    @property
    def started(self) -> datetime:
        return STARTED + timedelta(minutes=self.index)

    @property
    def id(self) -> str:
        return f"{self.started:%Y%m%d-%H%M%S}-{self.index:04x}"


class RecordingsBench:
    """pattern: a tick of the simulated rig, with everything in it.  frame: its picture."""

    def __init__(self, settings: RigFile | None = None) -> None:
        machine = build_machine(settings or RigFile(), realtime=False)
        try:
            machine.open()
            for _ in range(30):
                self.frame = machine.camera.read(0.1) or self.frame
                self.pattern = machine.loop.tick(self.frame, machine.camera.now())
            self._conditions = conditions_of(machine)
        finally:
            machine.close()

    def record(self, data: Path, walk: Walk | None = None) -> str:
        """Into that data folder; the id of the run, whose file and row are complete."""
        archive = Archive.open(data, patient=True)
        try:
            return self.record_in(archive, walk or Walk())
        finally:
            archive.close()

    def record_in(self, archive: Archive, walk: Walk, watch: Callable[[Snapshot], None] | None = None) -> str:
        """watch: told of each tick when it has been handed over."""
        run = _run(walk)
        archive.recorder.begin(run, self.conditions(walk))
        archive.recorder.event(Announcement(ZERO, "info", "running", "running"))
        tally = MetricsTally(LENGTH)
        last = round(walk.duration * walk.rate)
        for index in range(1, last + 1):
            snapshot = self.snapshot(run, index, index / walk.rate, tally)
            archive.recorder.tick(snapshot, self._frame(snapshot))
            if watch is not None:
                watch(snapshot)
        metrics = tally.metrics(Counts(last // 30, last // 30, last // 60), last / walk.rate)
        archive.recorder.event(Announcement(ZERO + last / walk.rate, "info", "armed", "run finished"))
        archive.recorder.end(replace(run, state=RunState.FINISHED, metrics=metrics))
        for more in range(1, math.ceil(TAIL * walk.rate) + 2):
            still = self.snapshot(run, last + more, (last + more) / walk.rate, MetricsTally(LENGTH))
            archive.recorder.tick(
                replace(still, rig=RigState.ARMED, run=None, reference=None, error=None), None
            )
        assert archive.recorder.written(walk.id, FINISH_WITHIN)
        return walk.id

    def conditions(self, walk: Walk) -> Conditions:
        recording = self._conditions.settings.recording.model_copy(update={"frames_Hz": walk.frame_rate})
        settings = self._conditions.settings.model_copy(update={"recording": recording})
        return replace(self._conditions, settings=settings)

    def snapshot(self, run: Run, index: int, elapsed: float, tally: MetricsTally) -> Snapshot:
        """The tick at `elapsed` s of the run."""
        angle = 2.0 * math.pi * elapsed / PERIOD
        error = ERROR * (1.0 + 0.5 * math.sin(7.0 * angle))
        reference = RADIUS * math.cos(angle), RADIUS * math.sin(angle)
        outside = (RADIUS + error) / RADIUS
        pose = Pose(reference[0] * outside, reference[1] * outside, angle + math.pi / 2)
        error = pose.distance_to(*reference)
        tally.add(pose, error)
        return replace(
            self.pattern,
            tick=index,
            time=ZERO + elapsed,
            captured_at=ZERO + elapsed - 0.035,
            rig=RigState.RUNNING,
            reason="",
            pose=pose,
            reference=reference,
            error=error,
            run=_progress(run.id, elapsed, tally.mean_error, index),
        )

    def _frame(self, snapshot: Snapshot) -> Frame:
        """The pattern's picture, moved on with each tick so that no two are alike."""
        image = np.roll(self.frame.image, snapshot.tick % self.frame.image.shape[1], axis=1)
        captured = snapshot.captured_at if snapshot.captured_at is not None else snapshot.time
        return Frame(image, captured, snapshot.tick)


def _run(walk: Walk) -> Run:
    selection = Selection(trajectory=Choice(walk.trajectory))
    request = RunRequest(selection, duration=walk.duration, label=walk.label, tags=walk.tags)
    return Run(walk.id, request, RunState.RUNNING, walk.started)


def _progress(id: str, elapsed: float, mean_error: float, index: int) -> RunProgress:
    return RunProgress(
        id=id,
        elapsed=elapsed,
        duration=PERIOD,
        passes=1.0,
        passes_done=elapsed / PERIOD,
        paused=False,
        mean_error=mean_error,
        steps=index // 30,
        sweeps=index // 30,
        reversals=index // 60,
    )
