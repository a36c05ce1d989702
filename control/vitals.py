"""What is known of the rig's health at each tick: the board's reports, the ages of things, the findings."""

from __future__ import annotations

import math

from control.acceptance import frame_problem, is_sound
from control.arbiter import LOOP_STALL, TELEMETRY_STALE, Finding, Health, Severity, assess
from control.coil_heat import UNKNOWN, CoilHeat
from control.current_check import AGREED, compare
from control.frame_log import FrameLog
from control.link.conversion import BoardState, Telemetry
from control.model import Frame, Pose
from control.parts import Parts
from control.response import ResponseWatch
from control.safety import ENERGISED, Refused
from control.snapshot import ZERO, Fault, Refusals, RigState, Vector
from control.workspace_guard import WorkspaceGuard

LONGEST_BLIND_DRIVE = 0.5
"""A board that hears nothing drives on for this long at most, s: the longest dead-man that it takes."""

REPORT_FRESH = 0.050
"""So long after what a report tells of the board's field is known, s: five reports, or three frames."""


class Vitals:
    """Listens to the board and asks the arbiter; keeps since when each thing has been wrong."""

    def __init__(self, parts: Parts, now: float) -> None:
        self._parts = parts
        self._frame_at = self._agreed_at = self._driving_at = now
        self._mismatch = AGREED
        self._frame_problem = ""
        self._refused_frames = self._refused_reports = 0
        self._since: dict[str, float] = {}
        self._response = ResponseWatch()
        self._stuck_sweeps = 0
        self._stuck_at = -math.inf
        self.guard = WorkspaceGuard(parts.limits.soft, parts.limits.hard, parts.length)
        self.heat = CoilHeat() if parts.simulated else UNKNOWN
        self.frames = FrameLog()
        self.telemetry: Telemetry | None = None
        self.findings: tuple[Finding, ...] = ()

    def frame_came(self, frame: Frame, now: float) -> bool:
        """Whether the picture may be looked at: it has this rig's shape, and a time."""
        self._frame_problem = frame_problem(frame, self._parts.frame_size)
        if self._frame_problem or not math.isfinite(frame.captured_at):
            self._refused_frames += 1
            return False
        self._frame_at = now
        self.frames.came(frame.captured_at, now)
        return True

    def saw(self, state: RigState, now: float) -> None:
        """A picture has just been looked at: hold the body's turn against a field that is as commanded."""
        observation = self._parts.perception.observation
        seen = observation.measurement if observation is not None else None
        if state in ENERGISED and seen is not None and self._field_is_known(now):
            self._response.see(self._parts.field.heading_at(seen.captured_at), seen.pose.heading)

    def _field_is_known(self, now: float) -> bool:
        """Whether the board has just said that it drives, and with the currents that it was asked for."""
        telemetry = self.telemetry
        return (
            telemetry is not None
            and telemetry.state is BoardState.DRIVING
            and now - self._parts.field.reported_at <= REPORT_FRESH
            and self._mismatch is AGREED
        )

    def walked(self, stuck_sweeps: int, now: float) -> None:
        """stuck_sweeps: how many sweeps of this walk were given up so far."""
        if stuck_sweeps > self._stuck_sweeps:
            self._stuck_at = now
        self._stuck_sweeps = stuck_sweeps

    def energised(self, now: float) -> None:
        """The arm edge has just been sent: board, currents and body get their time to follow."""
        self._restart_clocks(now)
        self._response.forget()

    def _restart_clocks(self, now: float) -> None:
        self._agreed_at = self._driving_at = now

    def hear(self, now: float, state: RigState) -> None:
        """Take the board's newest report and hold the mirror of its field against it."""
        telemetry = self._parts.link.poll()
        if telemetry is None:
            return
        if not is_sound(telemetry):
            self._refused_reports += 1
            return
        if self.telemetry is not None and telemetry.boot_id != self.telemetry.boot_id:
            self._parts.field.forget_clock()
        self.telemetry = telemetry
        self._parts.field.synchronise(telemetry.board_time, telemetry.received_at, telemetry.heading)
        if telemetry.state is BoardState.DRIVING or state not in ENERGISED:
            self._driving_at = now
        self._compare_currents(telemetry, now)

    def forget_report(self) -> None:
        """The board is greeted anew: what it said before is no news of it."""
        self.telemetry = None

    def judge(self, gap: float, now: float, state: RigState, pose: Pose | None) -> tuple[Finding, ...]:
        """Everything that is wrong now, most severe first. gap: since the last tick, s.

        What went on during a gap in which nobody looked says nothing about board and currents.
        """
        if not gap <= LOOP_STALL:
            self._restart_clocks(now)
        self._warm(gap, now)
        self.guard.follow(pose)
        self.findings = assess(self._health(gap, now, state, pose), self._parts.limits)
        self._since = {finding.code: self._since.get(finding.code, now) for finding in self.findings}
        return self.findings

    @property
    def blocking(self) -> str:
        """The worst finding that forbids current, in words; "" when none does."""
        return next((f.message for f in self.findings if f.severity >= Severity.HOLD), "")

    def require_none(self, state: RigState) -> None:
        """Raise `Refused` when something forbids current; a robot that is held outside may be driven back in."""
        for finding in self.findings:
            may_return = finding.code == "outside" and state is RigState.HELD
            if finding.severity >= Severity.HOLD and not may_return:
                raise Refused(finding.message)

    def faults(self, latched: Fault | None) -> tuple[Fault, ...]:
        """The latched cause first, then everything that is wrong now."""
        current = (Fault(f.code, f.message, self._since[f.code]) for f in self.findings)
        others = tuple(fault for fault in current if latched is None or fault.code != latched.code)
        return others if latched is None else (latched, *others)

    @property
    def refusals(self) -> Refusals:
        """What was not let in so far."""
        sightings = self._parts.perception.refused_sightings
        return Refusals(self._refused_frames, sightings, self._refused_reports)

    def _compare_currents(self, telemetry: Telemetry, now: float) -> None:
        mismatch = compare(
            telemetry.currents,
            telemetry.measured_currents,
            self._parts.limits.currents,
            supply_is_sensed=not telemetry.supply_assumed,
        )
        self._mismatch = mismatch
        if mismatch is AGREED:
            self._agreed_at = now

    def _warm(self, gap: float, now: float) -> None:
        """The coils' heat goes on with the currents that were last heard of, and without once they must be off."""
        driven = min(gap, LONGEST_BLIND_DRIVE)
        thermal = self._parts.thermal
        self.heat = self.heat.after(driven, self._currents(now), thermal).after(gap - driven, ZERO, thermal)

    def _currents(self, now: float) -> Vector:
        """Sensed, and commanded where a sense shows nothing at all, A."""
        telemetry = self.telemetry
        if telemetry is None or not now - telemetry.received_at <= TELEMETRY_STALE:
            return ZERO
        one, two, three = (
            sensed or commanded
            for sensed, commanded in zip(telemetry.measured_currents, telemetry.currents, strict=True)
        )
        return one, two, three

    def _health(self, gap: float, now: float, state: RigState, pose: Pose | None) -> Health:
        perception, link, telemetry = self._parts.perception, self._parts.link, self.telemetry
        frame = perception.frame
        heard_at = telemetry.received_at if telemetry is not None else now
        is_energised = state in ENERGISED
        is_engaged = is_energised or state is RigState.HELD
        return Health(
            tick_gap=gap,
            frame_age=now - self._frame_at if frame is not None else math.inf,
            frame_delay=now - frame.captured_at if frame is not None else math.inf,
            frame_problem=self._frame_problem,
            identical_frames=perception.identical_frames,
            tracking=perception.tracking,
            tracking_reason=perception.reason,
            tracking_age=perception.age,
            pose=pose,
            reach_limit=self.guard.hard_limit,
            turned_away=self._response.turned_away if is_energised else 0.0,
            stuck_age=now - self._stuck_at,
            link_ready=link.is_ready,
            link_reason=link.reason,
            link_incident=link.incident if is_engaged and telemetry is not None else "",
            bad_share=link.bad_share,
            line_lateness=link.lateness if is_energised else 0.0,
            telemetry_age=now - telemetry.received_at if telemetry is not None else math.inf,
            board_faults=telemetry.faults if telemetry is not None else (),
            board_state=telemetry.state.value if telemetry is not None else "",
            not_driving=heard_at - self._driving_at if is_energised else 0.0,
            current_mismatch=heard_at - self._agreed_at if is_energised else 0.0,
            mismatch=self._mismatch,
            coil_heat=self.heat.shares,
            is_too_hot=self.heat.is_too_hot,
            heat_wait=self.heat.wait(self._parts.thermal),
            camera_trouble=self._parts.camera_trouble(),
            calibration_problem=self._parts.calibration_problem(),
        )
