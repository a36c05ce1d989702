"""One tick of the loop as everybody else may see it."""

from __future__ import annotations

from dataclasses import dataclass

from control.link.conversion import Telemetry
from control.model import Pose
from control.parts import Parts
from control.safety import ENERGISED
from control.snapshot import ZERO, BoardReport, Fault, RigState, Snapshot, Vector
from control.timing import TimingLog
from control.vitals import Vitals
from control.walk import Walk


@dataclass(frozen=True, slots=True)
class Instant:
    """Where the loop is. time: rig time, s.  latched: the cause of the fault state.  pose_sigma: m, m, rad."""

    tick: int
    time: float
    state: RigState
    reason: str
    latched: Fault | None
    pose: Pose | None
    pose_sigma: Vector
    walk: Walk | None


def snapshot_of(instant: Instant, parts: Parts, vitals: Vitals, timing: TimingLog) -> Snapshot:
    """The record of this tick."""
    telemetry, walk, pose = vitals.telemetry, instant.walk, instant.pose
    frame, perception, actuation = parts.perception.frame, parts.perception, parts.actuation
    currents = telemetry.currents if telemetry is not None else ZERO
    reference = walk.reference if walk is not None else None
    is_energised = instant.state in ENERGISED
    return Snapshot(
        tick=instant.tick,
        time=instant.time,
        captured_at=frame.captured_at if frame is not None else None,
        rig=instant.state,
        reason=instant.reason,
        faults=vitals.faults(instant.latched),
        simulated=parts.simulated,
        pose=pose,
        pose_sigma=instant.pose_sigma,
        pose_covariance=perception.covariance,
        observation=perception.observation,
        tracking=perception.tracking,
        tracking_reason=perception.reason,
        tracking_age=perception.age,
        command=actuation.command,
        reference=reference,
        error=pose.distance_to(*reference) if pose is not None and reference is not None else None,
        currents=currents,
        measured_currents=telemetry.measured_currents if telemetry is not None else ZERO,
        field=parts.coils.local_field(pose.x, pose.y, currents) if pose is not None else ZERO,
        field_trace=parts.field.trace(),
        report=None if telemetry is None else _report(telemetry),
        limited_by=actuation.limited_by,
        coil_heat=vitals.heat.shares,
        refusals=vitals.refusals,
        body_tilt=parts.body_tilt(abs(telemetry.elevation)) if is_energised and telemetry else 0.0,
        run=walk.progress(instant.state is RigState.HELD) if walk is not None else None,
        camera=vitals.frames.figures,
        timing=timing.figures(),
        link=parts.link.status,
    )


def _report(telemetry: Telemetry) -> BoardReport:
    return BoardReport(telemetry.received_at, telemetry.board_time, telemetry.heading, telemetry.elevation)
