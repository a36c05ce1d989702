"""One tick: a frame in, a drive command out, one snapshot to everybody else.

The loop has no clock and no thread of its own; its shell (`server.rig`, or a headless run) reads the camera
and hands every frame in together with the rig's time. All methods belong to one thread, but `estop`, which
may come from any.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol

from control.actuation import Actuation
from control.coils import CoilSet
from control.controllers.manual import Jog, Manual
from control.field_model import FieldModel
from control.gait import Gait
from control.gait_model import GaitModel
from control.link.conversion import BoardState, LinkError, Telemetry
from control.link.port import Link
from control.metrics import Metrics
from control.model import PIVOT_A, Frame, Pivot, Pose, Tracking
from control.perception import Perception
from control.runs import RunRequest, RunState, Selection
from control.safety import (
    ENERGISED,
    Event,
    Finding,
    Health,
    Limits,
    Refused,
    Severity,
    after,
    assess,
    check_gait,
)
from control.snapshot import ZERO, Fault, RigState, Snapshot, Vector
from control.timing import TimingLog
from control.trajectories import check_inside
from control.walk import Walk
from control.walker import ControllerFault, Stride

MISMATCH_SHARE = 0.15
"""Sensed and commanded current may differ by this share of the limit: the sense is off by up to 25 % of a
small current, and the coils lag behind a ramp (firmware-notes.md)."""
LOG_LENGTH = 200
"""Announcements that wait for the shell to take them."""


class Camera(Protocol):
    """A source of frames; stamps them with the clock that `now` reads."""

    simulated: bool
    size: tuple[int, int]
    rate: float

    def read(self, timeout: float) -> Frame | None: ...

    def now(self) -> float: ...

    def close(self) -> None: ...


@dataclass(frozen=True, slots=True)
class Announcement:
    """One line of the event log. severity: "info", "warn" or "error".  time: rig time, s."""

    time: float
    severity: str
    code: str
    message: str


@dataclass(frozen=True, slots=True)
class Ended:
    """How a run ended."""

    id: str
    state: RunState
    reason: str
    metrics: Metrics


@dataclass(frozen=True, slots=True)
class Parts:
    """What the loop is made of; `server.assembly` builds it from the rig file."""

    perception: Perception
    actuation: Actuation
    field: FieldModel
    link: Link
    coils: CoilSet
    limits: Limits
    length: float
    simulated: bool
    gait_model: GaitModel
    """What is known of a pivot switch before the run begins."""
    body_tilt: Callable[[float], float]
    """From the field's tilt to the body's, rad, for drawing."""


class ControlLoop:
    """The rig's states and what each tick does in them."""

    def __init__(self, parts: Parts, stopwatch: Callable[[], float], now: float) -> None:
        """stopwatch: real seconds.  now: the rig's time, s."""
        self._parts = parts
        self._timing = TimingLog(stopwatch)
        self._state = RigState.DISARMED
        self._reason = "ready to arm"
        self._findings: tuple[Finding, ...] = ()
        self._since: dict[str, float] = {}
        self._latched: Fault | None = None
        self._walk: Walk | None = None
        self._gait = Gait()
        self._manual = Manual()
        self._outside = "estop", "emergency stop"
        self._tick = 0
        self._now = self._frame_at = now
        self._telemetry: Telemetry | None = None
        self._agreed_at = self._driving_at = now
        self._pose: Pose | None = None
        self._sigma: Vector = ZERO
        self._log: deque[Announcement] = deque(maxlen=LOG_LENGTH)
        self._ended: deque[Ended] = deque(maxlen=LOG_LENGTH)

    @property
    def state(self) -> RigState:
        return self._state

    def field_at(self, time: float) -> tuple[float, float]:
        """Heading (unwrapped) and elevation of the field at a recent rig time (s), rad."""
        return self._parts.field.heading_at(time), self._parts.field.elevation_at(time)

    @property
    def deciding(self) -> str:
        """The controller that the running tick waits for, "" for none; from any thread."""
        walk = self._walk
        return walk.walker.controller.name if walk is not None and walk.walker.is_deciding else ""

    def take_announcements(self) -> list[Announcement]:
        """What happened since the last call, oldest first."""
        return [self._log.popleft() for _ in range(len(self._log))]

    def take_ended(self) -> list[Ended]:
        """Runs that ended since the last call."""
        return [self._ended.popleft() for _ in range(len(self._ended))]

    # What the operator asks for ------------------------------------------------------------------

    def arm(self, gait: Gait) -> None:
        """Bring the field up along the robot's heading; raises `Refused`."""
        state = after(self._state, Event.ARM)
        check_gait(gait, self._parts.limits)
        self._require_fit()
        self._gait = gait
        self._energise()
        self._enter(state, "ready to start", "info")

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

    def latch_estop(self) -> None:
        """Enter the fault state after an `estop`; keeps the first cause of a fault that is on already."""
        if self._state is not RigState.FAULT:
            self._latch(*self._outside)

    def reset(self) -> None:
        """Leave the fault state, disarmed; a board that has latched a fault is greeted anew."""
        state = after(self._state, Event.RESET)
        if self._telemetry is not None and self._telemetry.faults:
            self._parts.link.greet()
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
        self._manual.forget()
        self._walk = walk
        self._gait = request.selection.gait
        self._enter(state, "walking", "info")

    def jog(self, jog: Jog) -> None:
        """Swing by hand for 300 ms at most; raises `Refused` unless armed without a run."""
        after(self._state, Event.JOG)
        gait = self._gait if jog.tilt is None else replace(self._gait, tilt=jog.tilt)
        check_gait(replace(gait, max_rate=abs(jog.rate)), self._parts.limits)
        self._gait = gait
        self._manual.take(jog, self._now)

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

    def pause(self) -> None:
        """Hold the run: zero current, and go on with `resume`."""
        if self._walk is None:
            raise Refused("there is no run to pause")
        self._hold("paused by the operator", "info")

    def resume(self) -> None:
        """Go on after a hold, from where the robot is; raises `Refused` while the cause is there."""
        state = after(self._state, Event.RESUME)
        pose = self._require_fit()
        self._energise()
        if self._walk is None:
            self._enter(RigState.ARMED, "ready to start", "info")
            return
        self._walk.walker.resume(pose.heading)
        self._enter(state, "walking", "info")

    # One tick ------------------------------------------------------------------------------------

    def tick(self, frame: Frame | None, now: float) -> Snapshot:
        """Take a frame (None: none came in time) at rig time `now`; returns what everybody may see."""
        gap, self._now = now - self._now, now
        self._tick += 1
        self._parts.field.advance(now)
        self._hear(now)
        if frame is not None:
            self._timing.frame_in(frame.index)
            self._frame_at = now
            self._parts.perception.look(frame)
        self._pose, self._sigma = self._parts.perception.pose_at(now)
        self._judge(gap, now)
        if self._state in ENERGISED:
            self._drive(now, gap)
        if frame is not None:
            self._timing.bytes_out()
        return self._snapshot()

    def _hear(self, now: float) -> None:
        telemetry = self._parts.link.poll()
        if telemetry is None:
            return
        if self._telemetry is not None and telemetry.boot_id != self._telemetry.boot_id:
            self._parts.field.forget_clock()
        self._telemetry = telemetry
        self._parts.field.synchronise(telemetry.board_time, telemetry.received_at, telemetry.heading)
        if telemetry.state is BoardState.DRIVING or self._state not in ENERGISED:
            self._driving_at = now
        if self._currents_agree(telemetry):
            self._agreed_at = now

    @property
    def _is_engaged(self) -> bool:
        """Driving, or holding a run or a place that may be resumed."""
        return self._state in ENERGISED or self._state is RigState.HELD

    def _currents_agree(self, telemetry: Telemetry) -> bool:
        pairs = zip(telemetry.currents, telemetry.measured_currents, self._parts.limits.currents, strict=True)
        return all(
            abs(abs(wanted) - abs(sensed)) <= MISMATCH_SHARE * limit for wanted, sensed, limit in pairs
        )

    def _judge(self, gap: float, now: float) -> None:
        self._findings = assess(self._health(gap, now), self._parts.limits)
        self._remember_since(now)
        if self._parts.actuation.stopped_from_outside and self._state is not RigState.FAULT:
            self._latch(*self._outside)
        if not self._findings:
            return
        worst = self._findings[0]
        if worst.severity is Severity.LATCH and self._state is not RigState.FAULT:
            self._latch(worst.code, worst.message)
        elif worst.severity is Severity.DISARM and self._state in ENERGISED | {RigState.HELD}:
            self._lose(worst)
        elif worst.severity is Severity.HOLD and self._state in ENERGISED:
            self._hold(worst.message, "error", worst.code)

    def _health(self, gap: float, now: float) -> Health:
        perception, link, telemetry = self._parts.perception, self._parts.link, self._telemetry
        frame = perception.frame
        heard_at = telemetry.received_at if telemetry is not None else now
        return Health(
            tick_gap=gap,
            frame_age=now - self._frame_at if frame is not None else math.inf,
            frame_delay=self._frame_at - frame.captured_at if frame is not None else math.inf,
            identical_frames=perception.identical_frames,
            tracking=perception.tracking,
            tracking_age=perception.age,
            pose=self._pose,
            link_ready=link.is_ready,
            link_reason=link.reason,
            link_incident=link.incident if self._is_engaged and telemetry is not None else "",
            telemetry_age=now - telemetry.received_at if telemetry is not None else math.inf,
            board_faults=telemetry.faults if telemetry is not None else (),
            not_driving=heard_at - self._driving_at if self._state in ENERGISED else 0.0,
            board_state=telemetry.state.value if telemetry is not None else "",
            current_mismatch=heard_at - self._agreed_at if self._state in ENERGISED else 0.0,
        )

    def _drive(self, now: float, gap: float) -> None:
        pose = self._pose
        if pose is None:
            return
        try:
            stride = self._stride(now, gap, pose)
            self._parts.actuation.drive(self._driven_by(now), stride, pose, self._gait)
        except ControllerFault as fault:
            self._latch("controller", str(fault))
        except ValueError as error:
            self._latch("command", f"the field cannot be commanded: {error}")
        except LinkError as error:
            self._lose(Finding(Severity.DISARM, "link", str(error)))
        if self._walk is not None and self._state is RigState.RUNNING and self._walk.is_over:
            self._end_run(RunState.FINISHED, "")
            self._enter(after(self._state, Event.FINISH), "run finished", "info")

    def _stride(self, now: float, gap: float, pose: Pose) -> Stride:
        field = self._parts.field
        if self._walk is None or self._state is not RigState.RUNNING:
            return self._by_hand(now)
        return self._walk.step(now, gap, pose, field, self._parts.perception)

    def _by_hand(self, now: float) -> Stride:
        """A fresh jog, or standing still."""
        field, jog = self._parts.field, self._manual.decide(now)
        if jog is None or jog.sweep is None or not field.is_ready:
            return Stride(field.pivot, 0.0, field.heading)
        return Stride(jog.pivot, jog.rate, field.heading + math.copysign(jog.sweep, jog.rate))

    def _driven_by(self, now: float) -> str:
        if self._walk is not None:
            return self._walk.request.selection.controller.name
        return self._manual.name if self._manual.decide(now) is not None else ""

    # Changes of state ----------------------------------------------------------------------------

    def _require_fit(self) -> Pose:
        """The pose, when nothing forbids current; raises `Refused` with the reason."""
        for finding in self._findings:
            if finding.severity >= Severity.HOLD:
                raise Refused(finding.message)
        if self._pose is None or self._parts.perception.tracking is not Tracking.LOCKED:
            raise Refused("the robot is not seen; put it in the camera's view and wait for a lock")
        for finding in self._findings:
            if finding.code == "margin" and self._state is RigState.DISARMED:
                raise Refused(f"{finding.message}; move it towards the centre first")
        return self._pose

    def _energise(self) -> None:
        pose = self._require_fit()
        if self._parts.actuation.stopped_from_outside:
            raise Refused("stopped; reset it first")
        self._agreed_at = self._driving_at = self._now
        try:
            self._parts.actuation.start(self._now, pose, self._standing_on(), self._gait)
        except LinkError as error:
            raise Refused(str(error)) from error

    def _standing_on(self) -> Pivot:
        return PIVOT_A if self._walk is None else self._walk.walker.sweep.pivot

    def _stop_coils(self) -> None:
        self._manual.forget()
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
            self._ended.append(Ended(self._walk.id, state, reason, self._walk.metrics()))
            self._walk = None

    def _enter(self, state: RigState, reason: str, severity: str, code: str = "") -> None:
        self._state, self._reason = state, reason
        self._log.append(Announcement(self._now, severity, code or state.value, reason))

    def _remember_since(self, now: float) -> None:
        self._since = {finding.code: self._since.get(finding.code, now) for finding in self._findings}

    # What everybody may see ----------------------------------------------------------------------

    def _snapshot(self) -> Snapshot:
        parts, telemetry, walk, pose = self._parts, self._telemetry, self._walk, self._pose
        currents = telemetry.currents if telemetry is not None else ZERO
        reference = walk.reference if walk is not None else None
        return Snapshot(
            tick=self._tick,
            time=self._now,
            captured_at=parts.perception.frame.captured_at if parts.perception.frame is not None else None,
            rig=self._state,
            reason=self._why(),
            faults=self._faults(),
            simulated=parts.simulated,
            pose=pose,
            pose_sigma=self._sigma,
            observation=parts.perception.observation,
            tracking=parts.perception.tracking,
            tracking_age=parts.perception.age,
            command=parts.actuation.command,
            reference=reference,
            error=pose.distance_to(*reference) if pose is not None and reference is not None else None,
            currents=currents,
            measured_currents=telemetry.measured_currents if telemetry is not None else ZERO,
            field=parts.coils.local_field(pose.x, pose.y, currents) if pose is not None else ZERO,
            saturated=parts.actuation.saturated,
            body_tilt=parts.body_tilt(abs(telemetry.elevation))
            if self._state in ENERGISED and telemetry
            else 0.0,
            run=walk.progress(self._state is RigState.HELD) if walk is not None else None,
            timing=self._timing.figures(),
            link=parts.link.status,
        )

    def _faults(self) -> tuple[Fault, ...]:
        """The latched cause first, then everything that is wrong now, most severe first."""
        latched = self._latched
        current = (Fault(f.code, f.message, self._since[f.code]) for f in self._findings)
        others = tuple(fault for fault in current if latched is None or fault.code != latched.code)
        return others if latched is None else (latched, *others)

    def _why(self) -> str:
        """The reason of the state; while disarmed, what stands in the way of arming."""
        blocking = (finding.message for finding in self._findings if finding.severity >= Severity.HOLD)
        return next(blocking, self._reason) if self._state is RigState.DISARMED else self._reason
