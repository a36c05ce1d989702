"""The topics of a recording: which there are, what they are called, and what they hold of one tick."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

from control.field import Corner
from control.model import Observation
from control.snapshot import RunProgress, Snapshot
from server.recording import foxglove
from server.recording.messages import (
    BrokenPart,
    CommandMessage,
    CornerPart,
    Currents,
    Estimate,
    FaultPart,
    FieldMessage,
    LinkMessage,
    Measurement,
    OfTick,
    Reference,
    RunPart,
    SelectionMessage,
    State,
    TimingMessage,
)
from server.recording.schemas import Schema, schema_of
from server.recording.tick_json import as_tick as as_tick

MILLI = 1e3
DEGREES = 180.0 / math.pi

OfSnapshot = Callable[[Snapshot, int], OfTick | None]
"""A snapshot and its UTC time (ns) to a message; None where there is nothing to tell."""


@dataclass(frozen=True, slots=True)
class Topic:
    """One topic. kind: type of its messages.  of: makes the message of each tick; None for what comes otherwise."""

    name: str
    schema_name: str
    kind: type[OfTick]
    of: OfSnapshot | None = None

    @property
    def schema(self) -> Schema:
        return {**schema_of(self.kind), "title": self.schema_name}


def finite(value: float | None, factor: float = 1.0) -> float | None:
    """The value times the factor; None for what JSON has no number for."""
    return value * factor if value is not None and math.isfinite(value) else None


def flat(points: Iterable[Iterable[float]]) -> tuple[float, ...]:
    return tuple(value for point in points for value in point)


def _state(snapshot: Snapshot, _: int) -> State:
    now, refused = snapshot.time, snapshot.refusals
    return State(
        time_s=now,
        tick=snapshot.tick,
        captured_s=finite(snapshot.captured_at),
        rig=snapshot.rig.value,
        reason=snapshot.reason,
        faults=[FaultPart(code=f.code, message=f.message, since_s=now - f.since) for f in snapshot.faults],
        simulated=snapshot.simulated,
        tracking=snapshot.tracking.value,
        tracking_reason=snapshot.tracking_reason,
        tracking_age_s=finite(snapshot.tracking_age),
        limited_by=snapshot.limited_by,
        coil_heat=snapshot.coil_heat,
        refused_frames=refused.frames,
        refused_sightings=refused.sightings,
        refused_reports=refused.reports,
        body_tilt_deg=math.degrees(snapshot.body_tilt),
        run=None if snapshot.run is None else _run(snapshot.run),
    )


def _run(run: RunProgress) -> RunPart:
    return RunPart(
        id=run.id,
        elapsed_s=run.elapsed,
        duration_s=finite(run.duration),
        passes=run.passes,
        passes_done=run.passes_done,
        paused=run.paused,
        mean_error_mm=run.mean_error * MILLI,
        steps=run.steps,
        sweeps=run.sweeps,
        reversals=run.reversals,
    )


def _pose(snapshot: Snapshot, utc: int) -> foxglove.PoseInFrame | None:
    pose = snapshot.pose
    if pose is None:
        return None
    half = 0.5 * pose.heading
    turned = foxglove.Quaternion(x=0.0, y=0.0, z=math.sin(half), w=math.cos(half))
    return foxglove.PoseInFrame(
        time_s=snapshot.time,
        tick=snapshot.tick,
        timestamp=foxglove.time_of(utc),
        frame_id=foxglove.WORKSPACE_FRAME,
        pose=foxglove.Pose(position=foxglove.Vector3(x=pose.x, y=pose.y, z=0.0), orientation=turned),
    )


def _measurement(snapshot: Snapshot, _: int) -> Measurement | None:
    seen = snapshot.observation
    return None if seen is None else Measurement(
        time_s=snapshot.time,
        tick=snapshot.tick,
        window_px=seen.window,
        rivals_px=flat(seen.rivals),
        reason=seen.reason,
        assumes_ends=seen.assumes_ends,
        **_sighting(seen),
    )  # fmt: skip


def _sighting(seen: Observation) -> dict[str, Any]:
    found = seen.measurement
    if found is None:
        return {}
    return {
        "captured_s": found.captured_at,
        "x_mm": found.pose.x * MILLI,
        "y_mm": found.pose.y * MILLI,
        "heading_deg": math.degrees(found.pose.heading),
        "centre_px": found.centre_image,
        "corners_px": flat(found.corners_image),
        "area_px": found.area_px,
    }


def _estimate(snapshot: Snapshot, _: int) -> Estimate | None:
    pose, (x, y, heading) = snapshot.pose, snapshot.pose_sigma
    if pose is None:
        return None
    return Estimate(
        time_s=snapshot.time,
        tick=snapshot.tick,
        x_mm=pose.x * MILLI,
        y_mm=pose.y * MILLI,
        heading_deg=math.degrees(pose.heading),
        sigma_x_mm=x * MILLI,
        sigma_y_mm=y * MILLI,
        sigma_heading_deg=math.degrees(heading),
        covariance_mm_deg=_covariance(snapshot),
    )


def _covariance(snapshot: Snapshot) -> tuple[float, ...]:
    """The whole (3, 3) matrix, row by row; mm^2, mm deg, deg^2."""
    xx, xy, xh, yy, yh, hh = snapshot.pose_covariance
    xx, xy, yy = xx * MILLI**2, xy * MILLI**2, yy * MILLI**2
    xh, yh, hh = xh * MILLI * DEGREES, yh * MILLI * DEGREES, hh * DEGREES**2
    return xx, xy, xh, xy, yy, yh, xh, yh, hh


def _reference(snapshot: Snapshot, _: int) -> Reference | None:
    if snapshot.reference is None:
        return None
    x, y = snapshot.reference
    error = finite(snapshot.error, MILLI)
    return Reference(time_s=snapshot.time, tick=snapshot.tick, x_mm=x * MILLI, y_mm=y * MILLI, error_mm=error)


def _command(snapshot: Snapshot, _: int) -> CommandMessage:
    command = snapshot.command
    return CommandMessage(
        time_s=snapshot.time,
        tick=snapshot.tick,
        controller=command.controller,
        pivot=command.pivot,
        rate_deg_s=math.degrees(command.rate),
        heading_goal_deg=math.degrees(command.heading_goal),
        tilt_deg=math.degrees(command.tilt),
        field_mT=command.field * MILLI,
    )


def _currents(snapshot: Snapshot, _: int) -> Currents:
    return Currents(
        time_s=snapshot.time,
        tick=snapshot.tick,
        commanded_A=snapshot.currents,
        measured_A=snapshot.measured_currents,
    )


def _field(snapshot: Snapshot, _: int) -> FieldMessage:
    x, y, z = snapshot.field
    trace = snapshot.field_trace
    return FieldMessage(
        time_s=snapshot.time,
        tick=snapshot.tick,
        field_mT=(x * MILLI, y * MILLI, z * MILLI),
        is_on=trace.is_on,
        heading_deg=math.degrees(trace.heading),
        elevation_deg=math.degrees(trace.elevation),
        strength_mT=trace.strength * MILLI,
        full_at_s=finite(trace.full_at),
        corners=[_corner(corner) for corner in trace.corners],
        corners_anew=trace.anew,
        **_report(snapshot),
    )


def _corner(corner: Corner) -> CornerPart:
    return CornerPart(
        time_s=corner.time,
        heading_deg=math.degrees(corner.heading),
        elevation_deg=math.degrees(corner.elevation),
    )


def _report(snapshot: Snapshot) -> dict[str, Any]:
    report = snapshot.report
    if report is None:
        return {}
    return {
        "board_heading_deg": math.degrees(report.heading),
        "board_elevation_deg": math.degrees(report.elevation),
        "board_time_s": report.board_time,
        "board_received_s": report.received_at,
    }


def _timing(snapshot: Snapshot, _: int) -> TimingMessage:
    loop, camera = snapshot.timing, snapshot.camera
    return TimingMessage(
        time_s=snapshot.time,
        tick=snapshot.tick,
        rate_Hz=finite(loop.rate),
        period_p99_ms=finite(loop.period_p99, MILLI),
        latency_p50_ms=finite(loop.latency_p50, MILLI),
        latency_p99_ms=finite(loop.latency_p99, MILLI),
        dropped_frames=loop.dropped_frames,
        camera_latency_ms=finite(camera.latency, MILLI),
        camera_rate_Hz=finite(camera.rate),
    )


def _link(snapshot: Snapshot, _: int) -> LinkMessage:
    link, counts = snapshot.link, snapshot.link.counts
    return LinkMessage(
        time_s=snapshot.time,
        tick=snapshot.tick,
        state=link.state,
        port=link.port,
        firmware=link.firmware,
        boot_id=link.boot_id,
        round_trip_ms=finite(link.round_trip, MILLI),
        round_trip_median_ms=finite(link.round_trip_median, MILLI),
        round_trip_p99_ms=finite(link.round_trip_p99, MILLI),
        bad_frames=link.bad_frames,
        bad_share=finite(link.bad_share),
        sent=counts.sent,
        received=counts.received,
        broken=[BrokenPart(what=what, count=count) for what, count in counts.broken.items()],
        resends=counts.resends,
        reconnects=counts.reconnects,
        board_bad=counts.board_bad,
        refused=counts.refused,
        stale=counts.stale,
        board_state=link.board_state,
        board_faults=link.board_faults,
        supply_V=finite(link.supply),
    )


EVENTS = Topic("/events", "foxglove.Log", foxglove.Log)
CAMERA = Topic("/camera", "foxglove.CompressedImage", foxglove.CompressedImage)
CALIBRATION = Topic("/camera/calibration", "foxglove.CameraCalibration", foxglove.CameraCalibration)
SELECTION = Topic("/selection", "pivotrig.Selection", SelectionMessage)

EACH_TICK = (
    Topic("/state", "pivotrig.State", State, _state),
    Topic("/pose", "foxglove.PoseInFrame", foxglove.PoseInFrame, _pose),
    Topic("/measurement", "pivotrig.Measurement", Measurement, _measurement),
    Topic("/estimate", "pivotrig.Estimate", Estimate, _estimate),
    Topic("/reference", "pivotrig.Reference", Reference, _reference),
    Topic("/command", "pivotrig.Command", CommandMessage, _command),
    Topic("/currents", "pivotrig.Currents", Currents, _currents),
    Topic("/field", "pivotrig.Field", FieldMessage, _field),
    Topic("/timing", "pivotrig.Timing", TimingMessage, _timing),
    Topic("/link", "pivotrig.Link", LinkMessage, _link),
)
TOPICS = (*EACH_TICK, EVENTS, CAMERA, CALIBRATION, SELECTION)
