"""Calibrations that let the robot walk, on the rig that is served: each is a run of the loop, under all interlocks.

One at a time. What was found stays here until it is saved, or measured again; what ends a run early (a hold, an
emergency stop, a robot that is lost) ends the calibration with that reason, and nothing is kept of it.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
from collections.abc import Callable
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from enum import StrEnum
from typing import TYPE_CHECKING, Any

from control.calibration.turning import Unclear
from control.identification import TooLittle
from control.runs import RunState
from control.safety import Refused
from control.snapshot import RigState
from server.assembly import Machine
from server.calibration.walk import CalibrationWalk, Findings, changed_since, with_advice
from server.lease.attendance import Permit, free
from server.settings import RigFile
from server.streams import StreamEnded

if TYPE_CHECKING:
    from server.rig import Rig

log = logging.getLogger(__name__)

EVENT = "calibration"
"""Code of this module's entries in the event log."""


class Kind(StrEnum):
    STAR = "star"
    LATENCY = "latency"


class Stage(StrEnum):
    """How far a calibration has come."""

    IDLE = "idle"
    WALKING = "walking"
    WORKING_OUT = "working_out"
    DONE = "done"
    FAILED = "failed"


@dataclass(frozen=True, slots=True)
class Calibration:
    """progress: 0..1.  reason: why it failed.  run_id: of its run.  at: when it was done, with its time zone.

    settings, rests_on: the rig that it was measured on, and what of it the findings depend on.
    """

    stage: Stage = Stage.IDLE
    progress: float = 0.0
    reason: str = ""
    run_id: str = ""
    findings: Findings | None = None
    at: str = ""
    settings: RigFile | None = None
    rests_on: tuple[str, ...] = ()

    @property
    def goes_on(self) -> bool:
        return self.stage in (Stage.WALKING, Stage.WORKING_OUT)


class CalibrationRuns:
    """The newest calibration of each kind."""

    def __init__(self, rig: Rig) -> None:
        self._rig = rig
        self._newest = dict.fromkeys(Kind, Calibration())
        self._task: asyncio.Task[None] | None = None

    def __getitem__(self, kind: Kind) -> Calibration:
        return self._newest[kind]

    async def start(
        self, kind: Kind, make: Callable[[Machine], CalibrationWalk], permit: Permit = free
    ) -> Calibration:
        """Begin on the armed rig; raises `Refused`, and what a bad choice raises."""
        busy = next((each for each in Kind if self._newest[each].goes_on), None)
        if busy is not None:
            raise Refused(f"the calibration {busy.value!r} goes on; wait for its end, or stop its run")
        walk, pose = make(self._rig.machine), self._rig.snapshot.pose
        if pose is not None and self._rig.snapshot.rig is RigState.ARMED:
            walk.check(pose)
        with contextlib.ExitStack() as watching:
            watching.enter_context(self._rig.watched(walk.watch))
            run = await self._rig.start_run(walk.request, permit)
            self._newest[kind] = Calibration(
                Stage.WALKING, run_id=run.id, settings=self._rig.settings, rests_on=walk.rests_on
            )
            work = self._carry_out(kind, walk, watching.pop_all())
            self._task = asyncio.create_task(work, name=f"calibration {kind}")
        return self._newest[kind]

    async def stop(self) -> None:
        """The server ends; so does whatever goes on."""
        if self._task is not None:
            self._task.cancel()
            await asyncio.gather(self._task, return_exceptions=True)

    def to_save(self, kind: Kind) -> dict[str, Any]:
        """What its findings change in the rig file; raises `Refused` where they do not hold for the rig as it is."""
        value = self._newest[kind]
        if value.findings is None or value.settings is None:
            raise Refused(f"the calibration {kind.value!r} has found nothing yet; start it")
        changed = changed_since(value.settings, self._rig.settings, value.findings, value.rests_on)
        if changed:
            raise Refused(
                f"{', '.join(changed)} changed since the calibration {kind.value!r} was measured, which holds for the "
                "rig as it was then; measure again"
            )
        return value.findings.changes

    async def _carry_out(self, kind: Kind, walk: CalibrationWalk, watching: contextlib.ExitStack) -> None:
        with watching:
            reason = await self._walked(kind, walk, self._newest[kind].run_id)
        if reason:
            self._fail(kind, with_advice(reason, walk.advice))
        else:
            await self._work_out(kind, walk)

    async def _walked(self, kind: Kind, walk: CalibrationWalk, run_id: str) -> str:
        """Follow the run to its end; "" when it came to it by itself, else why not."""
        with contextlib.suppress(StreamEnded):
            async with self._rig.updates.subscribe() as updates:
                while True:
                    snapshot, run = await updates.get(), self._rig.runs.of(run_id)
                    if run.state is RunState.FINISHED:
                        return ""
                    if run.state is not RunState.RUNNING:
                        return f"the walk was {run.state}: {run.reason}"
                    if snapshot.rig is RigState.HELD:
                        return await self._give_up(f"the walk was held: {snapshot.reason}")
                    if run.request.selection != walk.request.selection:
                        return await self._give_up("somebody changed the walk while it went on")
                    self._change(kind, progress=walk.progress(snapshot))
        return "the rig was closed"

    async def _give_up(self, reason: str) -> str:
        """End a run that is held or another one than was begun: what was seen would not fit together."""
        with contextlib.suppress(Refused):  # it has ended by itself meanwhile
            await self._rig.stop_run()
        return reason

    async def _work_out(self, kind: Kind, walk: CalibrationWalk) -> None:
        self._change(kind, stage=Stage.WORKING_OUT, progress=1.0)
        try:
            findings = await asyncio.to_thread(walk.findings)
        except (TooLittle, Unclear) as error:
            self._fail(kind, str(error))
        except Exception as error:  # a mistake of ours must not leave the calibration without an end
            log.exception("the calibration %s could not be worked out", kind)
            self._fail(kind, f"it could not be worked out ({error!r}); the log has the rest")
        else:
            at = datetime.now(UTC).astimezone().isoformat(timespec="seconds")
            self._change(kind, stage=Stage.DONE, findings=findings, at=at)
            self._rig.announce("info", EVENT, f"the calibration {kind.value!r} is done; save it or leave it")

    def _fail(self, kind: Kind, reason: str) -> None:
        self._newest[kind] = Calibration(Stage.FAILED, reason=reason, run_id=self._newest[kind].run_id)
        self._rig.announce("warn", EVENT, f"the calibration {kind.value!r} has failed: {reason}")

    def _change(self, kind: Kind, **changes: object) -> None:
        self._newest[kind] = replace(self._newest[kind], **changes)  # type: ignore[arg-type]
