"""The rig as the rest of the server sees it: the loop in a background task, its requests and its news.

Everything that may block (camera, OpenCV, serial port) and everything that changes the loop runs on one
dedicated thread, one thing after the other; the event loop only awaits it. An emergency stop alone goes
straight to the link.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import secrets
from collections import deque
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from datetime import UTC, datetime
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from control.coils import CoilSet
from control.controllers.manual import Jog
from control.model import Frame
from control.news import Announcement, Ended
from control.runs import Choice, Run, RunRequest, RunState, Selection
from control.safety import Refused
from control.snapshot import RigState, Snapshot
from control.trajectories import check_inside
from control.trajectories.custom import TooManyPaths, save_path
from control.trajectories.trajectory import points_of
from control.trajectories.waypoints import Smoothing
from server.api.choices import selection_json
from server.api.runs import run_json
from server.assembly import Machine
from server.settings import RigFile
from server.streams import Publisher, announcer
from server.watchdog import STALL, Hang, Watchdog, stopped
from vision.calibration import CameraModel

T = TypeVar("T")

log = logging.getLogger(__name__)

FRAME_TIMEOUT = 0.05
"""A tick happens at least this often, frame or not, s: half the age at which a camera counts as dead."""
ESTOP_ANSWER = 0.5
"""An emergency stop is answered after this long at the latest, s; the coils have been stopped at once."""
RUNS_KEPT = 1000
EVENTS_KEPT = 1000
TRAIL_POINTS = 600
"""The trail reaches back a minute at ten points a second."""
TRAIL_EVERY = 6


class Rig:
    """One rig, opened: start it, ask it, stop it."""

    def __init__(self, machine: Machine) -> None:
        self._machine = machine
        self._loop = machine.loop
        self._thread = ThreadPoolExecutor(max_workers=1, thread_name_prefix="rig")
        self._task: asyncio.Task[None] | None = None
        self._watchdog = Watchdog(lambda: machine.loop.deciding)
        self.hangs = False
        """The loop's thread does not come back: what it was asked for will not happen."""
        self._trail: deque[tuple[float, float]] = deque(maxlen=TRAIL_POINTS)
        self.settings: RigFile = machine.settings
        self.simulated = machine.camera.simulated
        self.frame: Frame | None = None
        self.snapshot: Snapshot = self._loop.tick(None, machine.camera.now())
        self.selection = Selection()
        self.runs: deque[Run] = deque(maxlen=RUNS_KEPT)
        self.events: deque[Announcement] = deque(maxlen=EVENTS_KEPT)
        self._news: deque[tuple[str, Run]] = deque(maxlen=EVENTS_KEPT)
        self.updates: Publisher[Snapshot] = Publisher()
        self.announcements: Publisher[dict[str, Any]] = announcer()
        self.custom_trajectories = CustomTrajectories()

    @property
    def coils(self) -> CoilSet:
        return self._machine.coils

    @property
    def camera_model(self) -> CameraModel:
        return self._machine.camera_model

    @property
    def body_height(self) -> float:
        """Height of the robot's top above the plate, m."""
        return self._machine.body_height

    @property
    def tracker(self) -> Any:
        return self._machine.tracker

    @property
    def failure(self) -> BaseException | None:
        """What ended the background task, if anything did."""
        if self._task is None or not self._task.done() or self._task.cancelled():
            return None
        return self._task.exception()

    async def start(self) -> None:
        """Open the link and start the loop."""
        await self._on_thread(self._machine.open)
        self._task = asyncio.create_task(self._run(), name="control loop")

    async def stop(self) -> None:
        """Zero the coils, end the loop and close everything; safe to call twice."""
        self._machine.stop_coils()
        self.updates.close()
        self.announcements.close()
        if self._task is not None:
            self._task.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await self._task
        await asyncio.to_thread(self._close)

    def stop_coils(self) -> None:
        """Zero now; for signal handlers."""
        self._machine.stop_coils()

    def _close(self) -> None:
        self._machine.camera.close()
        self._thread.shutdown(wait=not self.hangs, cancel_futures=True)
        self._machine.close()

    async def _run(self) -> None:
        try:
            while True:
                tick = asyncio.get_running_loop().run_in_executor(self._thread, self._one_tick)
                hang = await self._watchdog.wait(tick)
                if hang is not None:
                    self._hang(hang)
                self.snapshot = await tick
                self.hangs = False
                self._tell()
        except asyncio.CancelledError:
            raise
        except BaseException as error:
            self._fail(error)
            raise

    def _fail(self, error: BaseException) -> None:
        """The loop is broken for good: zero current, and say so to everybody who watches."""
        self._machine.stop_coils()
        log.exception("the control loop failed")
        reason = f"the control loop failed ({error!r}); restart pivotrig"
        self.snapshot = replace(self.snapshot, rig=RigState.FAULT, reason=reason)
        self.updates.publish(self.snapshot)

    def _hang(self, hang: Hang) -> None:
        """The loop does not come back: zero current, and say so; a loop that does come back latches the same."""
        self._loop.estop(hang.code, hang.reason)
        log.error("%s", hang.reason)
        self.hangs = True
        if self.snapshot.run is not None:
            self._end_hung_run(self.snapshot.run.id, hang.reason)
        self.snapshot = stopped(self.snapshot, hang)
        announcement = Announcement(self.snapshot.time, "error", hang.code, hang.reason)
        self.events.append(announcement)
        self.announcements.publish(_event_message(announcement))
        self.updates.publish(self.snapshot)

    def _end_hung_run(self, id: str, reason: str) -> None:
        for index, run in enumerate(self.runs):
            if run.id == id:
                self.runs[index] = replace(run, state=RunState.ABORTED, reason=reason)
                self._announce_run(RunState.ABORTED.value, self.runs[index])

    def _one_tick(self) -> Snapshot:
        frame = self._machine.camera.read(FRAME_TIMEOUT)
        if frame is not None:
            self.frame = frame
        return self._loop.tick(frame, self._machine.camera.now())

    async def _on_thread(self, work: Callable[[], T]) -> T:
        return await asyncio.get_running_loop().run_in_executor(self._thread, work)

    # News ----------------------------------------------------------------------------------------

    def _tell(self) -> None:
        """Publish the newest snapshot, and what the loop has announced since the last one."""
        if self.snapshot.pose is not None and self.snapshot.tick % TRAIL_EVERY == 0:
            self._trail.append((self.snapshot.pose.x, self.snapshot.pose.y))
        self.updates.publish(self.snapshot)
        for announcement in self._loop.take_announcements():
            self.events.append(announcement)
            self.announcements.publish(_event_message(announcement))
        while self._news:
            self._announce_run(*self._news.popleft())
        for ended in self._loop.take_ended():
            self._record_end(ended)

    def _record_end(self, ended: Ended) -> None:
        for index, run in enumerate(self.runs):
            if run.id == ended.id:
                done = replace(run, state=ended.state, reason=ended.reason, metrics=ended.metrics)
                self.runs[index] = done
                self._announce_run(ended.state.value, done)
                return

    def _announce_run(self, event: str, run: Run) -> None:
        self.announcements.publish({"type": "run", "event": event, "run": run_json(run)})

    # Requests ------------------------------------------------------------------------------------

    async def _ask(self, request: Callable[[], T]) -> T:
        """Carry a request out between two ticks and publish what became of it; raises `Refused`."""
        if self.failure is not None:
            raise Refused(self.snapshot.reason)
        answer = await self._unless_it_hangs(request)
        self.snapshot = await self._on_thread(self._look_again)
        self._tell()
        return answer

    async def _unless_it_hangs(self, request: Callable[[], T]) -> T:
        """The answer of the rig's thread; raises `Refused` when that does not come back."""
        if self.hangs:
            raise Refused(self.snapshot.reason)
        answer = asyncio.get_running_loop().run_in_executor(self._thread, request)
        while not (await asyncio.wait({answer}, timeout=STALL))[0]:
            if self.hangs:
                answer.cancel()
                raise Refused(self.snapshot.reason)
        return answer.result()

    def _look_again(self) -> Snapshot:
        return self._loop.tick(None, self._machine.camera.now())

    async def select(self, selection: Selection) -> None:
        """Choose what the next run uses; raises `OutsideWorkspace` and what a bad choice raises."""
        check_inside(selection.build_trajectory(), self.coils.workspace)
        selection.build_controller()
        self.selection = selection
        self.announcements.publish({"type": "rig", "selection": selection_json(selection)})

    async def arm(self) -> None:
        gait = self.selection.gait
        await self._ask(lambda: self._loop.arm(gait))

    async def disarm(self) -> None:
        await self._ask(self._loop.disarm)

    async def estop(self) -> None:
        """Zero at once, then latch; always succeeds, and soon, even where the loop hangs."""
        self._loop.estop()
        with contextlib.suppress(TimeoutError, Refused):
            await asyncio.wait_for(asyncio.shield(self._ask(self._loop.latch_estop)), ESTOP_ANSWER)

    async def reset(self) -> None:
        await self._ask(self._loop.reset)

    async def jog(self, jog: Jog) -> None:
        await self._ask(lambda: self._loop.jog(jog))

    async def start_run(self, request: RunRequest) -> Run:
        run = Run(new_id(), request, RunState.RUNNING, datetime.now(UTC))
        await self._ask(lambda: self._start(run))
        return self._run_of(run.id)

    def _start(self, run: Run) -> None:
        """On the rig's thread: the run is listed from the instant at which it may also end."""
        self._loop.start(run.id, run.request)
        self._trail.clear()
        self.runs.appendleft(run)
        self._news.append(("started", run))

    async def change_run(self, change: Callable[[Selection], Selection]) -> Run:
        """`change` makes the new selection of the old one, so that two changes at once both count."""
        id = await self._ask(lambda: self._change(change))
        return self._run_of(id)

    def _change(self, change: Callable[[Selection], Selection]) -> str:
        if self.snapshot.run is None or not self.runs or self.runs[0].state is not RunState.RUNNING:
            raise Refused("there is no run to change; arm the rig and start one")
        run = self.runs[0]
        selection = change(run.request.selection)
        self._loop.change(selection)
        self.runs[0] = replace(run, request=replace(run.request, selection=selection))
        self._news.append(("changed", self.runs[0]))
        return run.id

    async def stop_run(self) -> None:
        await self._ask(self._loop.stop_run)

    async def pause_run(self) -> None:
        await self._ask(self._loop.pause)

    async def resume_run(self) -> None:
        await self._ask(self._loop.resume)

    def _run_of(self, id: str) -> Run:
        return next(run for run in self.runs if run.id == id)

    # What there is to draw -----------------------------------------------------------------------

    def reference_points(self) -> NDArray[np.float64]:
        """(n, 2) points of the path that is walked or selected, m."""
        running = self.snapshot.run is not None and self.runs
        selection = self.runs[0].request.selection if running else self.selection
        return _path_points(selection.trajectory)

    def trail(self) -> NDArray[np.float64]:
        """(n, 2) recent estimates, m, oldest first."""
        return np.array(self._trail, dtype=float).reshape(-1, 2)


class CustomTrajectories:
    """Paths that somebody drew or sent, by name; kept for this session."""

    def save(
        self, name: str, points: NDArray[np.float64], closed: bool, speed: float, kind: Smoothing
    ) -> None:
        """Keep a path ((n, 2) points, m; m/s) under a free name; raises `Refused` when there are too many."""
        try:
            save_path(name, points, closed, speed, kind)
        except TooManyPaths as error:
            raise Refused(str(error)) from error


def _path_points(choice: Choice) -> NDArray[np.float64]:
    return points_of(Selection(trajectory=choice).build_trajectory())


def _event_message(announcement: Announcement) -> dict[str, Any]:
    return {
        "type": "event",
        "time_s": round(announcement.time, 4),
        "severity": announcement.severity,
        "code": announcement.code,
        "message": announcement.message,
    }


def new_id() -> str:
    """Sorts by time, reads well, never repeats."""
    return f"{datetime.now(UTC):%Y%m%d-%H%M%S}-{secrets.token_hex(2)}"
