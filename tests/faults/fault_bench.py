"""A simulated rig in simulated time with everything recorded, and one fault after the other put into it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from control.coil_heat import CoilHeat
from control.gait import Gait
from control.model import Pose, Tracking
from control.news import Announcement
from control.runs import Choice, Run, RunRequest, RunState, Selection
from control.simulation.board import TwinBoard
from control.simulation.faults.injection import Faults
from control.simulation.lockstep import Sample
from control.simulation.world import World
from control.snapshot import RigState, Snapshot, Vector
from server.archive import Archive
from server.assembly import Machine, build_machine
from server.headless import FRAME_TIMEOUT
from server.run_list import new_id
from server.run_recording import RunRecording
from server.settings import RigFile
from tests.faults.invariants import Electrics, Trace

GAIT = Gait(sweep=math.radians(10.0), tilt=math.radians(25.0))
EIGHT = Selection(Choice("geometric"), Choice("eight"), GAIT)
AT_HOME = Pose(0.0, -0.042, math.radians(90.0))
WALKS_FOR = 1.0
"""Before a fault, s: the field is up after 0.3 s."""


class RecordedBoard:
    """The world's board, each of its milliseconds written down."""

    def __init__(self, board: TwinBoard, trace: Trace) -> None:
        self._board = board
        self._trace = trace

    def advance(self, milliseconds: int) -> list[Vector]:
        return [self._millisecond() for _ in range(milliseconds)]

    def _millisecond(self) -> Vector:
        board = self._board
        (currents,) = board.advance(1)
        self._trace.samples.append(Sample(board.milliseconds, currents, board.duty))
        return currents

    def set_condition(self, name: str, value: int, coil: int | None = None) -> None:
        self._board.set_condition(name, value, coil)

    def reset(self) -> None:
        self._board.reset()

    def close(self) -> None:
        self._board.close()


@dataclass(frozen=True, slots=True)
class Reaction:
    """What a rig did about a fault. Times on the board's own clock, ms after the fault; None: not at all.

    noticed: the line of the log that says why it stops.  zero: the drive.  after: the state it led to.
    """

    fault: int
    noticed: int | None
    zero: int | None
    after: RigState
    code: str
    reason: str


class FaultBench:
    """A machine that is stepped by hand."""

    def __init__(self, settings: RigFile | None = None, archive: Archive | None = None) -> None:
        """archive: what its runs are recorded in, if anything."""
        self.archive = archive
        self.runs: list[str] = []
        self._recording = RunRecording(None if archive is None else archive.recorder)
        self.machine = build_machine(settings or RigFile().with_simulation(seed=3), realtime=False)
        self.loop = self.machine.loop
        self.trace = Trace()
        assert isinstance(self.world.board, TwinBoard)
        self.board = self.world.board
        self.world.board = RecordedBoard(self.board, self.trace)
        self.machine.open()
        self.snapshot = self.tick()

    @property
    def world(self) -> World:
        assert self.machine.world is not None
        return self.machine.world

    @property
    def faults(self) -> Faults:
        assert self.machine.faults is not None
        return self.machine.faults

    @property
    def now(self) -> float:
        return self.machine.camera.now()

    @property
    def electrics(self) -> Electrics:
        return electrics_of(self.machine)

    def tick(self) -> Snapshot:
        frame = self.machine.camera.read(FRAME_TIMEOUT)
        self._recording.heed(self.loop)
        self.snapshot = self._recording.keep(self.loop.tick(frame, self.now), frame)
        self.trace.snapshots.append(self.snapshot)
        self._heed_news()
        return self.snapshot

    def _heed_news(self) -> None:
        for line in self.loop.take_announcements():
            self.trace.events.append(line)
            self._recording.tell(line)
        for ended in self.loop.take_ended():
            self._recording.end(ended)

    def run_for(self, duration: float) -> Snapshot:
        until = self.now + duration
        while self.now < until:
            self.tick()
        return self.snapshot

    def until(self, condition: Callable[[Snapshot], bool], within: float = 3.0) -> Snapshot:
        give_up = self.now + within
        while not condition(self.tick()):
            assert self.now < give_up, f"still {self.snapshot.rig}: {self.snapshot.reason}"
        return self.snapshot

    # What an operator does

    def arm(self) -> None:
        self.until(_is_fit)
        self.loop.arm(GAIT)

    def arm_now(self) -> None:
        """Whether or not it is fit; raises `Refused`."""
        self.loop.arm(GAIT)

    def walk(self, selection: Selection = EIGHT) -> None:
        self.arm()
        self.walk_on(selection)

    def walk_on(self, selection: Selection = EIGHT) -> None:
        """Of a rig that is armed."""
        self.start(RunRequest(selection))
        self.run_for(WALKS_FOR)
        assert self.snapshot.rig is RigState.RUNNING, self.snapshot.reason

    def start(self, request: RunRequest) -> None:
        """Raises `Refused`, also where the run could not be recorded."""
        run = Run(new_id(), request, RunState.RUNNING, datetime.now(UTC))
        self._recording.check(self.machine)
        self.loop.start(run.id, request)
        self._recording.begin(self.machine, run)
        self.runs.append(run.id)

    def recording_at_the_end(self, number: int = 0) -> Path:
        """The recording of a run, all of them finished; the bench records no more."""
        assert self.archive is not None
        self.archive.recorder.close()
        return self.archive.path_of(self.runs[number])

    def go_on(self, tries: int = 1) -> None:
        """Whatever the state asks of the operator, until the robot walks again."""
        for _ in range(tries):
            self._go_on()
            if self.snapshot.rig is RigState.RUNNING:
                return
        raise AssertionError(f"it does not go on: {self.snapshot.reason}")

    def _go_on(self) -> None:
        if self.loop.state is RigState.HELD:
            self.until(_is_fit)
            self.loop.resume()
            self.run_for(0.5)
        elif self.loop.state is not RigState.RUNNING:
            if self.loop.state is RigState.FAULT:
                self.loop.reset()
            self.walk()

    # Faults

    def inject(self, name: str, **parameters: Any) -> int:
        """Put a fault in; the board's time, ms."""
        began = self.board.milliseconds
        self.faults.inject(name, parameters)
        return began

    def react(self, name: str, watch: float = 1.0, **parameters: Any) -> Reaction:
        """Put a fault into a rig that walks, and see what it does for a while."""
        logged = len(self.trace.events)
        fault = self.inject(name, **parameters)
        self.run_for(watch)
        noticed = next((e for e in self.trace.events[logged:] if _is_a_finding(e)), None)
        state = self.snapshot.rig
        zero = None
        if state is not RigState.RUNNING:
            zero = next(s.milliseconds for s in self.trace.after(fault) if not any(s.duty)) - fault
        return Reaction(
            fault=fault,
            noticed=None if noticed is None else round(noticed.time * 1e3) - fault,
            zero=zero,
            after=state,
            code="" if noticed is None else noticed.code,
            reason=self.snapshot.reason,
        )

    def mend(self, name: str) -> None:
        """Take the fault away; what happened once is put right by hand."""
        if name == "robot_put":
            self.world.nudge(AT_HOME)
        if name == "coil_hot":
            self.loop.coil_heat = CoilHeat()
        self.faults.clear(name)
        self.run_for(0.6)


def _is_a_finding(line: Announcement) -> bool:
    return line.severity == "error"


def _is_fit(snapshot: Snapshot) -> bool:
    return not snapshot.faults and snapshot.tracking is Tracking.LOCKED


def electrics_of(machine: Machine) -> Electrics:
    return electrics_in(machine.settings)


def electrics_in(settings: RigFile) -> Electrics:
    coils = settings.coils.x, settings.coils.y, settings.coils.z
    x, y, z = settings.limits.current_A
    r1, r2, r3 = (coil.resistance_ohm for coil in coils)
    t1, t2, t3 = (coil.inductance_mH * 1e-3 / coil.resistance_ohm for coil in coils)
    return Electrics(
        currents=(x, y, z),
        power=settings.limits.power_W,
        resistances=(r1, r2, r3),
        time_constants=(t1, t2, t3),
        dead_man=settings.link.dead_man_ms,
    )


@contextmanager
def fault_bench(settings: RigFile | None = None) -> Iterator[FaultBench]:
    """A bench whose runs are recorded."""
    with recorded(settings or RigFile().with_simulation(seed=3)) as bench:
        yield bench


@contextmanager
def recorded(settings: RigFile, *, patient: bool = True) -> Iterator[FaultBench]:
    """patient: the disk is waited for, so that simulated time, which goes faster, is no reason to fail."""
    with TemporaryDirectory() as folder:
        archive = Archive.open(Path(folder), patient=patient)
        bench = FaultBench(settings, archive)
        try:
            yield bench
        finally:
            bench.machine.close()
            archive.close()
