"""One tick: a frame in, a drive command out, one snapshot to everybody else.

The loop has no clock and no thread of its own; its shell (`server.rig_life`, or a headless run) reads the camera
and hands every frame in together with the rig's time. All methods belong to one thread, but `estop`, which
may come from any.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from control.arbiter import Finding, Severity
from control.coil_heat import ASSUMED_AT_START, CoilHeat
from control.controllers.manual import Jog
from control.gait import Gait
from control.instant import Instant, snapshot_of
from control.link.conversion import LinkError
from control.model import PIVOT_A, Frame, Pivot, Pose, Tracking
from control.news import Announcement, Ended, News
from control.parts import Parts
from control.runs import RunRequest, RunState, Selection
from control.safety import ENERGISED, Event, Refused, after, check_gait
from control.snapshot import ZERO, Fault, RigState, Snapshot, Vector
from control.steering import Steering
from control.timing import TimingLog
from control.trajectories import check_inside
from control.vitals import Vitals
from control.walk import Walk
from control.walker import ControllerFault

NEEDS_CONSENT = (
    "this rig is real: arming puts current into its coils. See that nobody is at the coils and nothing magnetic "
    "is near them, then arm with consent"
)
LEADS_OUT = (
    "the next step would lead the robot out of the workspace; resume goes on as soon as it leads inward"
)
NOT_SEEN = "the robot is not seen; put it in the camera's view and wait for a lock"
ASSUMED_ENDS = (
    "nothing but vision.heading_hint_deg tells which end of the robot is A: check it in the picture; if it is the "
    "wrong one, disarm and turn the robot round, or give end A a mark"
)
PAUSED = "paused by the operator"
"""Why a run is held that a person has paused, and that the same person lets go on."""
UNKNOWN_HEAT = (
    f"what the coils carried before this start is not known: they count as {ASSUMED_AT_START:.0%} hot"
)


class ControlLoop:
    """The rig's states and what each tick does in them."""

    def __init__(self, parts: Parts, stopwatch: Callable[[], float], now: float) -> None:
        """stopwatch: real seconds.  now: the rig's time, s."""
        self._parts = parts
        self._timing = TimingLog(stopwatch)
        self._state = RigState.DISARMED
        self._reason = "ready to arm"
        self._vitals = Vitals(parts, now)
        self._steering = Steering(parts, self._vitals.guard)
        self._latched: Fault | None = None
        self._walk: Walk | None = None
        self._gait = Gait()
        self._outside = "estop", "emergency stop"
        self._tick = 0
        self._now = now
        self._pose: Pose | None = None
        self._sigma: Vector = ZERO
        self._news = News()
        if not parts.simulated:
            self.announce("info", "heat", UNKNOWN_HEAT)

    @property
    def state(self) -> RigState:
        return self._state

    @property
    def parts(self) -> Parts:
        """For who drives the rig while this loop is not stepped."""
        return self._parts

    def field_at(self, time: float) -> tuple[float, float]:
        """Heading (unwrapped) and elevation of the field at a recent rig time (s), rad."""
        return self._parts.field.heading_at(time), self._parts.field.elevation_at(time)

    @property
    def deciding(self) -> str:
        """The controller that the running tick waits for, "" for none; from any thread."""
        walk = self._walk
        return walk.walker.controller.name if walk is not None and walk.walker.is_deciding else ""

    @property
    def obstacle(self) -> str:
        """Why no current may flow now, "" when it may; a warning is no reason."""
        return self._vitals.blocking or ("" if self._is_seen else NOT_SEEN)

    @property
    def _is_seen(self) -> bool:
        return self._pose is not None and self._parts.perception.tracking is Tracking.LOCKED

    def announce(self, severity: str, code: str, message: str) -> None:
        """A line of the event log from somebody else on the rig's thread."""
        self._news.add(Announcement(self._now, severity, code, message))

    @property
    def coil_heat(self) -> CoilHeat:
        """The estimate of the coils' heat, for a loop that takes over the same coils."""
        return self._vitals.heat

    @coil_heat.setter
    def coil_heat(self, heat: CoilHeat) -> None:
        self._vitals.heat = heat

    def take_announcements(self) -> list[Announcement]:
        """What happened since the last call, oldest first."""
        return self._news.take_lines()

    def take_ended(self) -> list[Ended]:
        """Runs that ended since the last call."""
        return self._news.take_ended()

    # What the operator asks for ------------------------------------------------------------------

    def arm(self, gait: Gait, *, consent: bool = False) -> None:
        """Bring the field up along the robot's heading; raises `Refused`.

        consent: the operator has just said that current may flow, without which a real rig does not arm.
        """
        state = after(self._state, Event.ARM)
        if not (self._parts.simulated or consent):
            raise Refused(NEEDS_CONSENT)
        check_gait(gait, self._parts.limits)
        self._energise(gait)
        self._gait = gait
        self._enter(state, "ready to start", "info")
        if self._parts.perception.assumes_ends:
            self.announce("info", "heading", ASSUMED_ENDS)

    def disarm(self, reason: str = "disarmed by the operator") -> None:
        """Zero the coils and end the run; nothing to do when disarmed already."""
        if self._state is RigState.DISARMED:
            return
        state = after(self._state, Event.DISARM)
        self._stop_coils()
        self._end_run(RunState.ABORTED, reason)
        self._enter(state, reason, "info")

    def estop(self, code: str = "estop", reason: str = "emergency stop") -> None:
        """Zero now; from any thread. The state follows at the next tick, or at `latch_estop`."""
        if not self._parts.actuation.stopped_from_outside:
            self._outside = code, reason
        self._parts.actuation.stop_from_outside()

    def forget_robot(self) -> None:
        """Look for the robot as at the start; only for a rig that drives nothing."""
        self._parts.perception.forget()

    def latch_estop(self) -> None:
        """Enter the fault state after an `estop`; keeps the first cause of a fault that is on already."""
        if self._state is not RigState.FAULT:
            self._latch(*self._outside)

    def reset(self) -> None:
        """Leave the fault state, disarmed; a board that has latched a fault is greeted anew."""
        state = after(self._state, Event.RESET)
        if self._vitals.telemetry is not None and self._vitals.telemetry.faults:
            self._parts.link.greet()
            self._vitals.forget_report()
        self._parts.actuation.allow()
        self._latched = None
        self._enter(state, "reset; arm to go on", "info")

    def start(self, id: str, request: RunRequest) -> None:
        """Start a run; raises `Refused`, or what a bad selection raises."""
        state = after(self._state, Event.START)
        check_gait(request.selection.gait, self._parts.limits)
        pose = self._require_fit()
        walk = Walk(id, request, self._parts.length, self._parts.field.pivot, pose)
        check_inside(walk.trajectory, self._parts.coils.workspace)
        walk.workspace = self._parts.coils.workspace
        walk.gait_model = self._parts.gait_model
        walk.put_controllers_into(self._parts.controller_case)
        self._steering.forget()
        self._walk = walk
        self._gait = request.selection.gait
        self._enter(state, "walking", "info")

    def jog(self, jog: Jog) -> None:
        """Swing by hand for 300 ms at most; raises `Refused` unless armed without a run."""
        after(self._state, Event.JOG)
        gait = self._gait if jog.tilt is None else replace(self._gait, tilt=jog.tilt)
        check_gait(replace(gait, max_rate=abs(jog.rate)), self._parts.limits)
        self._steering.take(jog, self._pose, self._now)
        self._gait = gait

    def change(self, selection: Selection) -> None:
        """Another controller, trajectory or gait for the run that is on; raises like `start`."""
        if self._walk is None:
            raise Refused("there is no run to change; start one first")
        check_gait(selection.gait, self._parts.limits)
        check_inside(selection.build_trajectory(), self._parts.coils.workspace)
        self._walk.change(selection)
        self._gait = selection.gait

    def stop_run(self) -> None:
        """End the run; an armed rig stays armed, a held one is disarmed."""
        if self._walk is None:
            raise Refused("there is no run to stop")
        self._end_run(RunState.STOPPED, "stopped by the operator")
        if self._state is RigState.HELD:
            self.disarm("run stopped while held")
        else:
            self._enter(after(self._state, Event.FINISH), "run stopped", "info")

    def abort_run(self, code: str, reason: str) -> None:
        """End the run for a cause outside the loop, and disarm; nothing to do while there is none."""
        if self._walk is not None:
            self._lose(Finding(Severity.DISARM, code, reason))

    def pause(self) -> None:
        """Hold the run: zero current, and go on with `resume`."""
        if self._walk is None:
            raise Refused("there is no run to pause")
        self._hold(PAUSED, "info")

    @property
    def is_unattended(self) -> bool:
        """A run goes on that needs nobody who looks after it."""
        return self._walk is not None and self._walk.request.unattended

    def hold(self, reason: str, code: str) -> None:
        """Coils off for a cause outside the loop; a run is kept, and `resume` goes on. For an energised rig."""
        self._hold(reason, "error", code)

    def rest(self, reason: str) -> None:
        """Coils off on an armed rig that has no run; `resume` brings the field back. Raises `Refused`."""
        if self._walk is not None or self._state is not RigState.ARMED:
            raise Refused(f"only an armed rig without a run can rest; it is {self._state}")
        self._hold(reason, "info")

    def abandon_run(self, reason: str) -> None:
        """End the run for good and hold the rig, with the coils off, so that `resume` leads to an armed rig."""
        if self._walk is None:
            raise Refused("there is no run to abandon")
        if self._state is not RigState.HELD:
            self._hold(reason, "warn")
        self._end_run(RunState.ABORTED, reason)

    def resume(self) -> None:
        """Go on after a hold, from where the robot is; raises `Refused` while the cause is there."""
        state = after(self._state, Event.RESUME)
        pose = self._energise(self._gait)
        self._vitals.guard.resumed(pose)
        if self._walk is None:
            self._enter(RigState.ARMED, "ready to start", "info")
            return
        self._walk.walker.resume(pose.heading)
        self._enter(state, "walking", "info")

    # One tick ------------------------------------------------------------------------------------

    def tick(self, frame: Frame | None, now: float) -> Snapshot:
        """Take a frame (None: none came in time) at rig time `now`; returns what everybody may see."""
        gap = now - self._now
        if math.isfinite(now):
            self._now = now
        now = self._now
        self._tick += 1
        self._parts.field.advance(now)
        self._vitals.hear(now, self._state)
        if frame is not None:
            self._timing.frame_in(frame.index)
            self._look(frame, now)
        self._pose, self._sigma = self._parts.perception.pose_at(now)
        self._judge(gap, now)
        if self._state in ENERGISED:
            self._drive(now, gap)
        self._heed_outside()
        if frame is not None:
            self._timing.bytes_out()
        return self._snapshot()

    def _look(self, frame: Frame, now: float) -> None:
        if self._vitals.frame_came(frame, now):
            self._parts.perception.look(frame)
            self._vitals.saw(self._state, now)

    def _judge(self, gap: float, now: float) -> None:
        if self._walk is not None:
            self._vitals.walked(self._walk.walker.stuck, now)
        findings = self._vitals.judge(gap, now, self._state, self._pose)
        self._news.warn_of(findings, now)
        self._heed_outside()
        if not findings:
            return
        worst = findings[0]
        if worst.severity is Severity.LATCH and self._state is not RigState.FAULT:
            self._latch(worst.code, worst.message)
        elif worst.severity is Severity.DISARM and self._state in ENERGISED | {RigState.HELD}:
            self._lose(worst)
        elif worst.severity is Severity.HOLD and self._state in ENERGISED:
            self._hold(worst.message, "error", worst.code)

    def _heed_outside(self) -> None:
        """A stop from another thread is heeded in the tick in which it comes, also while that waits for a controller:
        what was seen to be off is never shown as driving."""
        if self._parts.actuation.stopped_from_outside and self._state is not RigState.FAULT:
            self._latch(*self._outside)

    def _drive(self, now: float, gap: float) -> None:
        pose = self._pose
        if pose is None:
            return
        try:
            self._command(now, gap, pose)
        except ControllerFault as fault:
            self._latch("controller", str(fault))
        except LinkError as error:
            self._lose(Finding(Severity.DISARM, "link", str(error)))
        except Exception as error:  # noqa: BLE001 (a path may be anyone's code; whatever it is, no current)
            self._latch("command", f"no command could be worked out: {error!r}")
        if self._walk is not None and self._state is RigState.RUNNING and self._walk.is_over:
            self._end_run(RunState.FINISHED, "")
            self._enter(after(self._state, Event.FINISH), "run finished", "info")

    def _command(self, now: float, gap: float, pose: Pose) -> None:
        """Send this tick's stride; one that leads out of the workspace holds a run and lets a jog stand still."""
        walk = self._walk if self._state is RigState.RUNNING else None
        stride = self._steering.stride(walk, now, gap, pose)
        if self._steering.leads_out(stride, pose, now):
            if walk is not None:
                self._hold(LEADS_OUT, "error", "margin")
                return
            stride = self._steering.standing()
        self._parts.actuation.drive(self._steering.driven_by(walk, now), stride, pose, self._gait)

    # Changes of state ----------------------------------------------------------------------------

    def _require_fit(self) -> Pose:
        """The pose, when nothing forbids current; raises `Refused` with the reason."""
        self._vitals.require_none(self._state)
        if self._pose is None or not self._is_seen:
            raise Refused(NOT_SEEN)
        return self._pose

    def _energise(self, gait: Gait) -> Pose:
        """The arm edge, at the robot's pose; raises `Refused`."""
        pose = self._require_fit()
        if self._parts.actuation.stopped_from_outside:
            raise Refused("stopped; reset it first")
        self._vitals.energised(self._now)
        self._vitals.guard.energised(pose)
        try:
            self._parts.actuation.start(self._now, pose, self._standing_on(), gait)
        except LinkError as error:
            self._stop_coils()
            raise Refused(str(error)) from error
        return pose

    def _standing_on(self) -> Pivot:
        return PIVOT_A if self._walk is None else self._walk.walker.sweep.pivot

    def _stop_coils(self) -> None:
        self._steering.forget()
        self._vitals.guard.rest()
        self._parts.actuation.stop(self._now)

    def _hold(self, reason: str, severity: str, code: str = "hold") -> None:
        state = after(self._state, Event.HOLD)
        self._stop_coils()
        self._enter(state, reason, severity, code)

    def _lose(self, finding: Finding) -> None:
        self._stop_coils()
        self._end_run(RunState.ABORTED, finding.message)
        self._enter(after(self._state, Event.DISARM), finding.message, "error", finding.code)

    def _latch(self, code: str, reason: str) -> None:
        self._stop_coils()
        self._end_run(RunState.ABORTED, reason)
        self._latched = Fault(code, reason, self._now)
        self._enter(after(self._state, Event.LATCH), reason, "error", code)

    def _end_run(self, state: RunState, reason: str) -> None:
        if self._walk is not None:
            self._news.end(Ended(self._walk.id, state, reason, self._walk.metrics()))
            self._walk = None

    def _enter(self, state: RigState, reason: str, severity: str, code: str = "") -> None:
        self._state, self._reason = state, reason
        self.announce(severity, code or state.value, reason)

    # What everybody may see ----------------------------------------------------------------------

    def _snapshot(self) -> Snapshot:
        instant = Instant(
            tick=self._tick,
            time=self._now,
            state=self._state,
            reason=self._why(),
            latched=self._latched,
            pose=self._pose,
            pose_sigma=self._sigma,
            walk=self._walk,
        )
        return snapshot_of(instant, self._parts, self._vitals, self._timing)

    def _why(self) -> str:
        """The reason of the state; while disarmed, what stands in the way of arming."""
        return self._vitals.blocking or self._reason if self._state is RigState.DISARMED else self._reason
