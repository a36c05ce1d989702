"""The rig's life: the loop in a background task, what it shows to whoever watches, and its end.

Everything that may block (camera, OpenCV, serial port) and everything that changes the loop runs on one
dedicated thread, one thing after the other; the event loop only awaits it. An emergency stop alone goes
straight to the link.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeVar

from control.coils import CoilSet
from control.model import Frame
from control.news import Announcement
from control.runs import RunState, Selection
from control.safety import ENERGISED, Refused
from control.simulation.faults.injection import Faults
from control.snapshot import RigState, Snapshot
from server.assembly import Machine, build_machine
from server.custom_trajectories import CustomTrajectories
from server.event_log import Event, EventLog, Told
from server.exchange import Build
from server.lease.attendance import Attendance, NoLease, Permit, free, permitted
from server.occupation import Occupation
from server.rig_thread import RigThread
from server.run_list import RunList
from server.run_recording import RunRecording
from server.settings import RigFile
from server.streams import Publisher
from server.trail import Trail
from server.watchdog import Hang, Watchdog, stopped

if TYPE_CHECKING:
    from server.recording.writing.recorder import Recorder

T = TypeVar("T")

log = logging.getLogger(__name__)

FRAME_TIMEOUT = 0.034
"""A tick happens at least this often, frame or not, s: the third without a frame finds the camera dead (102 ms)."""
ENDED = "pivotrig was ended"
"""Why a run ends that goes on when the program does."""
LINES_WAITING = 1000
"""Lines of the log that wait to be told."""
LAST_TURN = 2.0
"""At the end an exchange that goes on is waited for, but not for ever, s (gone within 5 s, faults.md row 16)."""


class RigLife:
    """One rig, opened: start it, watch it, stop it. `server.rig.Rig` can be asked for something, too."""

    def __init__(
        self, machine: Machine, build: Build | None = None, recorder: Recorder | None = None
    ) -> None:
        """build: makes another machine when settings are changed; by default like `machine`, in real time.

        recorder: keeps the runs; None: nothing is kept of them.
        """
        self._machine = machine
        self._build = build or (lambda settings: build_machine(settings, realtime=True))
        self._loop = machine.loop
        self._recording = RunRecording(recorder)
        self._lines: deque[Told] = deque(maxlen=LINES_WAITING)
        self._thread = RigThread()
        self._task: asyncio.Task[None] | None = None
        self._watchdog = Watchdog(lambda: self._loop.deciding)
        self._stops = 0
        self._lost = ""
        self._trail = Trail()
        self._watchers: list[Callable[[Snapshot], None]] = []
        self.frame: Frame | None = None
        self.snapshot: Snapshot = self._loop.tick(None, machine.camera.now())
        self.selection = Selection()
        self.runs = RunList()
        self._log = EventLog()
        self.updates: Publisher[Snapshot] = Publisher()
        self.custom_trajectories = CustomTrajectories()
        self.occupation = Occupation()
        self.attendance: Attendance = NoLease()

    @property
    def machine(self) -> Machine:
        """The parts as they are now; another object after each exchange, so do not keep it."""
        return self._machine

    @property
    def settings(self) -> RigFile:
        return self._machine.settings

    @property
    def coils(self) -> CoilSet:
        return self._machine.coils

    @property
    def faults(self) -> Faults | None:
        """What is injected into a simulated rig; None on a real one."""
        return self._machine.faults

    @property
    def events(self) -> Sequence[Event]:
        """What has happened, oldest first."""
        return self._log.entries

    @property
    def event_log(self) -> EventLog:
        return self._log

    @property
    def announcements(self) -> Publisher[dict[str, Any]]:
        """What clients are told as it comes: events, runs, changes of the selection and of the rig."""
        return self._log.messages

    @property
    def is_lost(self) -> bool:
        """No machine is open: an exchange failed both ways."""
        return bool(self._lost)

    @property
    def hangs(self) -> bool:
        """The loop's thread does not come back."""
        return self._thread.hangs

    @property
    def failure(self) -> BaseException | None:
        """What ended the background task, if anything did."""
        if self._task is None or not self._task.done() or self._task.cancelled():
            return None
        return self._task.exception()

    async def start(self) -> None:
        """Open the link and start the loop; a board or a camera that is not there yet is waited for, disarmed."""
        self._recording.start()
        await self._thread.begin(lambda: self._machine.open(patiently=True, camera_may_come=True))
        self._task = asyncio.create_task(self._run(), name="control loop")

    async def stop(self) -> None:
        """Zero the coils, end the loop and close everything; safe to call twice."""
        self.stop_coils("ended", ENDED)
        self.updates.close()
        self.announcements.close()
        if self._task is not None:
            self._task.cancel()
            await asyncio.gather(self._task, return_exceptions=True)  # what it failed with has been told of
        with contextlib.suppress(Refused):
            async with self._thread.turn(LAST_TURN):
                if not self.hangs:
                    await self._thread.begin(self._end_run)
                await asyncio.to_thread(self._close)
                return
        await asyncio.to_thread(self._close)

    def stop_coils(self, code: str = "estop", reason: str = "emergency stop") -> None:
        """Zero now; for signal handlers."""
        self._stops += 1
        self._machine.loop.estop(code, reason)
        self.occupation.stop(reason, is_end=code == "ended")

    def _end_run(self) -> None:
        """The program ends, and so does a run; its recording says why."""
        try:
            self._loop.abort_run("ended", ENDED)
            self._heed_news()
        except Exception:  # a loop that has failed is closed all the same
            log.exception("the run could not be ended in good order")

    def _close(self) -> None:
        self._machine.camera.close()
        self._thread.shutdown()
        self._machine.close()

    async def _run(self) -> None:
        try:
            while True:
                async with self._thread.turn():
                    await self._step()
        except asyncio.CancelledError:
            raise
        except BaseException as error:
            self._fail(error)
            raise

    async def _step(self) -> None:
        if self._lost:
            await asyncio.sleep(FRAME_TIMEOUT)
            return
        tick = self._thread.begin(self._one_tick)
        hang = await self._watchdog.wait(tick)
        if hang is not None:
            self._hang(hang)
        self.snapshot = await tick
        self._thread.hangs = False
        self._tell()

    def _fail(self, error: BaseException) -> None:
        """The loop is broken for good: zero current, and say so to everybody who watches."""
        self._machine.stop_coils()
        log.exception("the control loop failed")
        reason = f"the control loop failed ({error!r}); restart pivotrig"
        self._abort_run(reason)
        self._show_fault(reason)

    def _show_fault(self, reason: str) -> None:
        self.snapshot = replace(self.snapshot, rig=RigState.FAULT, reason=reason)
        self.updates.publish(self.snapshot)

    def _hang(self, hang: Hang) -> None:
        """The loop does not come back: zero current, and say so; a loop that does come back latches the same."""
        self._loop.estop(hang.code, hang.reason)
        log.error("%s", hang.reason)
        self._thread.hangs = True
        self.announce("error", hang.code, hang.reason)
        self._abort_run(hang.reason)
        self.snapshot = stopped(self.snapshot, hang)
        self._log.tell_runs(self.runs.take_news())
        self.updates.publish(self.snapshot)

    def _abort_run(self, reason: str) -> None:
        """The loop itself will not say how its run has ended."""
        if self.snapshot.run is not None:
            self.runs.abort(self.snapshot.run.id, reason)
            self._recording.abort(reason)

    def _one_tick(self) -> Snapshot:
        frame = self._machine.camera.read(FRAME_TIMEOUT)
        if frame is not None:
            self.frame = frame
        for note in self._machine.camera.take_notes():
            self._loop.announce(note.severity, "camera", note.message)
        self._heed_absence()
        snapshot = self._tick(frame)
        self._show(snapshot)
        return snapshot

    def _heed_absence(self) -> None:
        """What nobody looks after does not go on, unless it belongs to the server: unattended runs and campaigns."""
        loop = self._loop
        if loop.state not in ENERGISED or loop.is_unattended or self.occupation.is_taken:
            return
        reason = self.attendance.absence(loop.state is RigState.RUNNING)
        if reason:
            loop.hold(reason, "operator")

    def _tick(self, frame: Frame | None) -> Snapshot:
        self._recording.heed(self._loop)
        snapshot = self._loop.tick(frame, self._machine.camera.now())
        snapshot = self._recording.keep(snapshot, frame)
        self._heed_news()
        return snapshot

    def _heed_news(self) -> None:
        """On the rig's thread: what the loop has to tell goes to the recording in the order in which it happened."""
        for line in self._loop.take_announcements():
            self._recording.tell(line)
            self._lines.append(Told.now(line, self._run_id()))
        for ended in self._loop.take_ended():
            self._recording.end(ended)
            self.runs.end(ended)

    # Watchers ------------------------------------------------------------------------------------

    @contextlib.contextmanager
    def watched(self, watcher: Callable[[Snapshot], None]) -> Iterator[None]:
        """`watcher` is told of every tick meanwhile, on the rig's thread; none is left out, as with `updates`."""
        self._watchers = [*self._watchers, watcher]
        try:
            yield
        finally:
            self._watchers = [each for each in self._watchers if each is not watcher]

    def _show(self, snapshot: Snapshot) -> None:
        for watcher in self._watchers:
            try:
                watcher(snapshot)
            except Exception:  # whoever watches may fail, control does not notice (faults.md, rule 8)
                log.exception("a watcher of the rig failed, and is told of nothing more")
                self._watchers = [each for each in self._watchers if each is not watcher]

    # News ----------------------------------------------------------------------------------------

    def _tell(self) -> None:
        """Publish the newest snapshot, and what the loop has announced since the last one."""
        self._trail.follow(self.snapshot)
        self.updates.publish(self.snapshot)
        for _ in range(len(self._lines)):
            self._log.add(self._lines.popleft())
        self._log.tell_runs(self.runs.take_news())

    def announce(self, severity: str, code: str, message: str) -> None:
        """Put something into the event log and tell everybody who watches."""
        line = Announcement(self.snapshot.time, severity, code, message)
        self._recording.tell(line)
        self._log.add(Told.now(line, self._run_id()))

    def _run_id(self) -> str:
        """Of the run that goes on, or ""."""
        newest = next(iter(self.runs), None)
        return newest.id if newest is not None and newest.state is RunState.RUNNING else ""

    # Between two ticks ---------------------------------------------------------------------------

    async def _ask(self, request: Callable[[], T], permit: Permit = free) -> T:
        """Carry a request out between two ticks and publish what became of it; raises `Refused`.

        permit: asked just before, on the rig's thread, where one command comes after the other.
        """
        if self.failure is not None or self._lost:
            raise Refused(self.snapshot.reason)
        answer = await self._thread.call(lambda: permitted(request, permit), lambda: self.snapshot.reason)
        with contextlib.suppress(Refused):  # a tick that hangs has been told of; the request is carried out
            self.snapshot = await self._thread.call(self._look_again, lambda: self.snapshot.reason)
        self._tell()
        return answer

    def _look_again(self) -> Snapshot:
        return self._tick(None)

    async def between_ticks(self, work: Callable[[], T], permit: Permit = free) -> T:
        """Do something to the rig's parts on the thread that owns them; raises `Refused` when that hangs."""
        return await self._ask(work, permit)
