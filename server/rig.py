"""The rig as the rest of the server sees it: what it may be asked for, and other settings in the place of its own."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Callable
from datetime import UTC, datetime
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from control.controllers.manual import Jog
from control.runs import Run, RunRequest, RunState, Selection
from control.safety import Refused
from control.snapshot import RigState
from control.trajectories import check_inside
from control.trajectories.trajectory import points_of
from server.api.choices import selection_json
from server.assembly import Machine
from server.exchange import Build, Exchange, NoMachine, exchange, require_disarmed
from server.lease.attendance import Permit, free, permitted
from server.rig_life import RigLife
from server.run_list import new_id
from server.settings import RigFile
from server.vision_settings import tracker_settings

if TYPE_CHECKING:
    from server.recording.writing.recorder import Recorder

ESTOP_ANSWER = 0.5
"""An emergency stop is answered after this long at the latest, s; the coils have been stopped at once."""
TURN_WITHIN = 10.0
"""A tick, or an exchange of the machine with a slow camera, is over after this long, s."""


class Rig(RigLife):
    """One rig, opened: start it, ask it, stop it."""

    def __init__(
        self, machine: Machine, build: Build | None = None, recorder: Recorder | None = None
    ) -> None:
        super().__init__(machine, build, recorder)
        self._stops_before_exchange = 0

    # Requests ------------------------------------------------------------------------------------

    async def select(self, selection: Selection, by: str | None = None) -> None:
        """Choose what the next run uses; raises `OutsideWorkspace` and what a bad choice raises.

        by: who chooses, in the client's own words, so that it knows its own choice when everybody is told of it.
        """
        check_inside(selection.build_trajectory(), self.coils.workspace)
        selection.build_controller()
        self.selection = selection
        self.announcements.publish({"type": "rig", "selection": selection_json(selection), "by": by})

    async def arm(self, *, consent: bool = False, permit: Permit = free) -> None:
        """consent: the operator agrees that current flows through real coils."""
        gait = self.selection.gait
        await self._ask(lambda: self._loop.arm(gait, consent=consent), permit)

    async def disarm(self) -> None:
        self.occupation.stop("the operator disarmed the rig")
        await self._ask(lambda: self._loop.disarm())

    async def estop(self) -> None:
        """Zero at once, then latch; always succeeds, and soon, even where the loop hangs."""
        self._stops += 1
        self._loop.estop()
        self.occupation.stop("emergency stop")
        with contextlib.suppress(TimeoutError, Refused):
            latch = self._ask(lambda: self._loop.latch_estop())
            await asyncio.wait_for(asyncio.shield(latch), ESTOP_ANSWER)

    async def reset(self, permit: Permit = free) -> None:
        await self._ask(lambda: self._loop.reset(), permit)

    async def jog(self, jog: Jog, permit: Permit = free) -> None:
        self.occupation.require_none()
        await self._ask(lambda: self._loop.jog(jog), permit)

    async def start_run(self, request: RunRequest, permit: Permit = free) -> Run:
        self.occupation.require_none()

        def may_begin() -> None:
            permit()
            self.occupation.require_none()

        return await self.begin_run(request, may_begin)

    async def begin_run(self, request: RunRequest, permit: Permit) -> Run:
        """`start_run` for who has the rig to itself."""
        id = new_id()
        await asyncio.to_thread(self.check_recording)
        await self._ask(lambda: self._start(id, request), permit)
        return self.runs.of(id)

    def _start(self, id: str, request: RunRequest) -> None:
        """On the rig's thread: the run is listed from the instant at which it may also end."""
        self._loop.start(id, request)
        run = Run(id, request, RunState.RUNNING, datetime.now(UTC))
        self._recording.begin(self._machine, run)
        self._trail.clear()
        self.runs.start(run)

    def check_recording(self) -> None:
        """Raises `Refused` where a run could not be recorded; from any thread, and it blocks."""
        self._recording.check(self._machine)

    def is_recorded(self, id: str) -> bool:
        """Whether a run that is over is all in its recording and in the catalogue; from any thread."""
        return self._recording.is_complete(id)

    async def change_run(self, change: Callable[[Selection], Selection], permit: Permit = free) -> Run:
        """`change` makes the new selection of the old one, so that two changes at once both count."""
        self.occupation.require_none()
        id = await self._ask(lambda: self._change(change), permit)
        return self.runs.of(id)

    def _change(self, change: Callable[[Selection], Selection]) -> str:
        if self.snapshot.run is None or not self.runs or self.runs[0].state is not RunState.RUNNING:
            raise Refused("there is no run to change; arm the rig and start one")
        run = self.runs[0]
        selection = change(run.request.selection)
        self._loop.change(selection)
        self._recording.change(selection)
        self.runs.change_newest(selection)
        return run.id

    async def stop_run(self) -> None:
        self.occupation.stop("the operator stopped its run")
        await self._ask(lambda: self._loop.stop_run())

    async def pause_run(self) -> None:
        await self._ask(lambda: self._loop.pause())

    async def resume_run(self, permit: Permit = free) -> None:
        await self._ask(lambda: self._loop.resume(), permit)

    async def follow(self, u: float, v: float, permit: Permit = free) -> None:
        """The operator says where in the picture (px) the robot is; raises `Refused` while it is driven."""
        await self._ask(lambda: self._follow(u, v), permit)

    def _follow(self, u: float, v: float) -> None:
        if self._loop.state not in (RigState.DISARMED, RigState.HELD):
            state = self._loop.state
            raise Refused(f"the robot can be pointed at while the rig is disarmed or held; it is {state}")
        self._machine.tracker.follow(u, v)

    # Other settings ------------------------------------------------------------------------------

    def take_settings(self, settings: RigFile) -> None:
        """Settings that no part of the machine has been built from, such as the rig's name."""
        self._machine.settings = settings
        self._announce_settings()

    async def retune(self, settings: RigFile, permit: Permit = free) -> None:
        """Settings of which only the robot's looks are new, for the tracker; raises `Refused` unless disarmed."""
        self.occupation.require_none()
        await self._ask(lambda: self._retune(settings), permit)
        self._announce_settings()

    def _retune(self, settings: RigFile) -> None:
        """On the rig's thread, where nothing can arm it meanwhile."""
        require_disarmed(self._loop.state, "what the robot looks like")
        turned = settings.vision.heading_hint_deg != self.settings.vision.heading_hint_deg
        self._machine.tracker.retune(tracker_settings(settings.vision))
        if turned:
            self._loop.forget_robot()
        self._machine.settings = settings

    async def rebuild(self, settings: RigFile, permit: Permit = free) -> None:
        """Put a machine with other settings in this one's place, between two ticks.

        Raises `Refused`, and then the rig is as it was, unless it is `NoMachine`.
        """
        self.occupation.require_none()
        await asyncio.shield(asyncio.ensure_future(self._rebuild(settings, permit)))

    async def _rebuild(self, settings: RigFile, permit: Permit) -> None:
        if self.hangs:
            raise Refused(self.snapshot.reason)
        async with self._thread.turn(TURN_WITHIN):
            try:
                exchange = await self._thread.begin(
                    lambda: permitted(lambda: self._exchange(settings), permit)
                )
            except NoMachine as error:
                self._lose_machine(str(error))
                raise
            self._lost = ""
            self.snapshot = await self._thread.begin(self._look_again)
        self._tell()
        self._announce_settings()
        if exchange.failure is not None:
            reason = f"the changed rig cannot be opened, and is as it was: {exchange.failure}"
            self.announce("warn", "rig", reason)
            raise Refused(reason)

    def _lose_machine(self, reason: str) -> None:
        self._lost = reason
        self.announce("error", "rig", reason)
        self._show_fault(reason)

    def _exchange(self, settings: RigFile) -> Exchange:
        """On the rig's thread, where nothing can arm it meanwhile."""
        if not self._lost:
            require_disarmed(self._loop.state)
            self._stops_before_exchange = self._stops
        self._recording.leave()
        done = exchange(self._machine, settings, self._build)
        self._machine, self._loop = done.machine, done.machine.loop
        if self._stops != self._stops_before_exchange:  # a stop that found no machine holds for the new one
            self._loop.estop()
        self.frame = None
        self._trail.clear()
        return done

    def _announce_settings(self) -> None:
        self.announcements.publish({"type": "rig", "settings": self.settings.to_public()})

    # What there is to draw -----------------------------------------------------------------------

    def reference_points(self) -> NDArray[np.float64]:
        """(n, 2) points of the path that is walked or selected, m."""
        return points_of(Selection(trajectory=self.walked.trajectory).build_trajectory())

    @property
    def walked(self) -> Selection:
        """What the run that is on walks by; while there is none, what the next one will."""
        running = self.snapshot.run is not None and self.runs
        return self.runs[0].request.selection if running else self.selection

    def trail(self) -> NDArray[np.float64]:
        """(n, 2) recent estimates, m, oldest first."""
        return self._trail.points()
