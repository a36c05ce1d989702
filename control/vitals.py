"""What is known of the rig's health at each tick: the board's reports, the ages of things, the findings."""

from __future__ import annotations

import math

from control.link.conversion import BoardState, Telemetry
from control.model import Pose
from control.parts import Parts
from control.safety import ENERGISED, Finding, Health, Refused, Severity, assess
from control.snapshot import Fault, RigState

MISMATCH_SHARE = 0.15
"""Sensed and commanded current may differ by this share of the limit: the sense is off by up to 25 % of a
small current, and the coils lag behind a ramp (firmware-notes.md)."""


class Vitals:
    """Listens to the board and asks the arbiter; keeps since when each thing has been wrong."""

    def __init__(self, parts: Parts, now: float) -> None:
        self._parts = parts
        self._frame_at = self._agreed_at = self._driving_at = now
        self._since: dict[str, float] = {}
        self.telemetry: Telemetry | None = None
        self.findings: tuple[Finding, ...] = ()

    def frame_came(self, now: float) -> None:
        self._frame_at = now

    def energised(self, now: float) -> None:
        """The arm edge has just been sent: board and currents get their time to follow."""
        self._agreed_at = self._driving_at = now

    def hear(self, now: float, state: RigState) -> None:
        """Take the board's newest report and hold the mirror of its field against it."""
        telemetry = self._parts.link.poll()
        if telemetry is None:
            return
        if self.telemetry is not None and telemetry.boot_id != self.telemetry.boot_id:
            self._parts.field.forget_clock()
        self.telemetry = telemetry
        self._parts.field.synchronise(telemetry.board_time, telemetry.received_at, telemetry.heading)
        if telemetry.state is BoardState.DRIVING or state not in ENERGISED:
            self._driving_at = now
        if self._currents_agree(telemetry):
            self._agreed_at = now

    def judge(self, gap: float, now: float, state: RigState, pose: Pose | None) -> tuple[Finding, ...]:
        """Everything that is wrong now, most severe first. gap: since the last tick, s."""
        self.findings = assess(self._health(gap, now, state, pose), self._parts.limits)
        self._since = {finding.code: self._since.get(finding.code, now) for finding in self.findings}
        return self.findings

    @property
    def blocking(self) -> str:
        """The worst finding that forbids current, in words; "" when none does."""
        return next((f.message for f in self.findings if f.severity >= Severity.HOLD), "")

    def require_none(self, state: RigState) -> None:
        """Raise `Refused` when something forbids current, or arming so near to the edge."""
        if self.blocking:
            raise Refused(self.blocking)
        for finding in self.findings:
            if finding.code == "margin" and state is RigState.DISARMED:
                raise Refused(f"{finding.message}; move it towards the centre first")

    def faults(self, latched: Fault | None) -> tuple[Fault, ...]:
        """The latched cause first, then everything that is wrong now."""
        current = (Fault(f.code, f.message, self._since[f.code]) for f in self.findings)
        others = tuple(fault for fault in current if latched is None or fault.code != latched.code)
        return others if latched is None else (latched, *others)

    def _currents_agree(self, telemetry: Telemetry) -> bool:
        pairs = zip(telemetry.currents, telemetry.measured_currents, self._parts.limits.currents, strict=True)
        return all(
            abs(abs(wanted) - abs(sensed)) <= MISMATCH_SHARE * limit for wanted, sensed, limit in pairs
        )

    def _health(self, gap: float, now: float, state: RigState, pose: Pose | None) -> Health:
        perception, link, telemetry = self._parts.perception, self._parts.link, self.telemetry
        frame = perception.frame
        heard_at = telemetry.received_at if telemetry is not None else now
        is_engaged = state in ENERGISED or state is RigState.HELD
        return Health(
            tick_gap=gap,
            frame_age=now - self._frame_at if frame is not None else math.inf,
            frame_delay=self._frame_at - frame.captured_at if frame is not None else math.inf,
            identical_frames=perception.identical_frames,
            tracking=perception.tracking,
            tracking_age=perception.age,
            pose=pose,
            link_ready=link.is_ready,
            link_reason=link.reason,
            link_incident=link.incident if is_engaged and telemetry is not None else "",
            telemetry_age=now - telemetry.received_at if telemetry is not None else math.inf,
            board_faults=telemetry.faults if telemetry is not None else (),
            not_driving=heard_at - self._driving_at if state in ENERGISED else 0.0,
            board_state=telemetry.state.value if telemetry is not None else "",
            current_mismatch=heard_at - self._agreed_at if state in ENERGISED else 0.0,
        )
