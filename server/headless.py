"""One run without a browser: the same loop, as fast as it goes when the rig is simulated."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

from control.news import Ended
from control.runs import RunRequest, RunState
from control.safety import Refused
from control.snapshot import RigState, Snapshot
from server.assembly import Machine

FRAME_TIMEOUT = 0.034
"""As in `server.rig_life`, s."""
READY_WITHIN = 5.0
"""Camera, track and board must be there after this long, s of rig time."""


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
    """Arm, walk, disarm. Raises `Refused` when the rig does not get ready or a fault ends the run.

    consent: a person agrees that current flows, without which a real rig does not arm.
    """
    started, begin = time.perf_counter(), machine.camera.now()
    try:
        machine.open()
        _until_ready(machine, watch)
        machine.loop.arm(request.selection.gait, consent=consent)
        machine.loop.start(id, request)
        ended = _walk(machine, watch)
        machine.loop.disarm("run finished")
        _tick(machine, watch)
        return HeadlessRun(ended, time.perf_counter() - started, machine.camera.now() - begin)
    finally:
        machine.close()


def _tick(machine: Machine, watch: Watch | None) -> Snapshot:
    frame = machine.camera.read(FRAME_TIMEOUT)
    snapshot = machine.loop.tick(frame, machine.camera.now())
    if watch is not None:
        watch(snapshot)
    return snapshot


def _until_ready(machine: Machine, watch: Watch | None) -> None:
    give_up = machine.camera.now() + READY_WITHIN
    while True:
        _tick(machine, watch)
        obstacle = machine.loop.obstacle
        if not obstacle:
            return
        if machine.camera.now() > give_up:
            raise Refused(f"the rig is not ready: {obstacle}")


def _walk(machine: Machine, watch: Watch | None) -> Ended:
    while True:
        snapshot = _tick(machine, watch)
        for ended in machine.loop.take_ended():
            if ended.state is RunState.ABORTED:
                raise Refused(f"the run was aborted: {ended.reason}")
            return ended
        if snapshot.rig is RigState.HELD:
            raise Refused(f"the run was held: {snapshot.reason}")
