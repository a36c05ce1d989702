"""A snapshot as the outside sees it: in the lab's units, with null for what is unknown."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from control.model import Measurement, Observation, Pose
from control.snapshot import (
    CameraTiming,
    Command,
    Fault,
    LinkCounts,
    LinkStatus,
    RecordingStatus,
    Refusals,
    RunProgress,
    Snapshot,
    Timing,
)

if TYPE_CHECKING:
    from server.rig_life import RigLife

MILLI = 1e3


def number(value: float | None, digits: int = 4) -> float | None:
    """The value, rounded; None for what JSON has no number for."""
    return round(value, digits) if value is not None and math.isfinite(value) else None


def scaled(value: float | None, factor: float, digits: int = 4) -> float | None:
    return None if value is None else number(value * factor, digits)


def degrees(value: float | None, digits: int = 3) -> float | None:
    return None if value is None else number(math.degrees(value), digits)


def numbers(values: Iterable[float], factor: float = 1.0, digits: int = 4) -> list[float | None]:
    return [number(value * factor, digits) for value in values]


def state(snapshot: Snapshot, operator: dict[str, Any] | None = None) -> dict[str, Any]:
    """The fields of GET /state and of a tick. operator: who has the rig's lease."""
    return {
        "rig": snapshot.rig.value,
        "reason": snapshot.reason,
        "faults": [fault(each, snapshot.time) for each in snapshot.faults],
        "simulated": snapshot.simulated,
        "tick": snapshot.tick,
        "time_s": number(snapshot.time),
        "captured_s": number(snapshot.captured_at),
        "tracking": snapshot.tracking.value,
        "tracking_reason": snapshot.tracking_reason,
        "tracking_age_s": number(snapshot.tracking_age),
        "error_mm": scaled(snapshot.error, MILLI),
        "saturated": bool(snapshot.limited_by),
        "limited_by": snapshot.limited_by,
        "refused": refusals(snapshot.refusals),
        "body_tilt_deg": degrees(snapshot.body_tilt),
        **robot(snapshot),
        **sighting(snapshot.observation),
        **coils(snapshot),
        "command": command(snapshot.command),
        "run": run(snapshot.run),
        "camera": camera(snapshot.camera),
        "loop": loop(snapshot.timing),
        "link": link(snapshot.link),
        "recording": recording(snapshot.recording),
        "operator": operator,
    }


def state_of(rig: RigLife) -> dict[str, Any]:
    """The newest state of a rig."""
    return state(rig.snapshot, rig.attendance.in_state())


def robot(snapshot: Snapshot) -> dict[str, Any]:
    x, y, heading = snapshot.pose_sigma
    reference = snapshot.reference
    return {
        "pose": pose(snapshot.pose),
        "pose_sigma": {"x_mm": scaled(x, MILLI), "y_mm": scaled(y, MILLI), "heading_deg": degrees(heading)},
        "reference": None if reference is None else point(*reference),
    }


def coils(snapshot: Snapshot) -> dict[str, Any]:
    return {
        "currents_A": numbers(snapshot.currents),
        "measured_currents_A": numbers(snapshot.measured_currents),
        "field_mT": numbers(snapshot.field, MILLI),
        "coil_heat": numbers(snapshot.coil_heat),
    }


def refusals(value: Refusals) -> dict[str, int]:
    """What was not let in since the program began."""
    return {"frames": value.frames, "sightings": value.sightings, "reports": value.reports}


def sighting(observation: Observation | None) -> dict[str, Any]:
    if observation is None:
        return {"measurement": None, "window_px": None, "rivals_px": []}
    return {
        "measurement": measurement(observation.measurement),
        "window_px": list(observation.window),
        "rivals_px": [numbers(rival, digits=1) for rival in observation.rivals],
    }


def point(x: float, y: float) -> dict[str, Any]:
    return {"x_mm": scaled(x, MILLI), "y_mm": scaled(y, MILLI)}


def pose(value: Pose | None) -> dict[str, Any] | None:
    return None if value is None else {**point(value.x, value.y), "heading_deg": degrees(value.heading)}


def measurement(seen: Measurement | None) -> dict[str, Any] | None:
    if seen is None:
        return None
    return {
        **(pose(seen.pose) or {}),
        "centre_px": numbers(seen.centre_image, digits=2),
        "corners_px": [numbers(corner, digits=2) for corner in seen.corners_image],
    }


def command(value: Command) -> dict[str, Any]:
    return {
        "controller": value.controller,
        "pivot": value.pivot,
        "rate_deg_s": degrees(value.rate),
        "heading_goal_deg": degrees(value.heading_goal),
        "tilt_deg": degrees(value.tilt),
        "field_mT": scaled(value.field, MILLI),
    }


def fault(value: Fault, now: float) -> dict[str, Any]:
    """`since_s` is how long it has been there, s."""
    return {"code": value.code, "message": value.message, "since_s": number(now - value.since, 2)}


def run(value: RunProgress | None) -> dict[str, Any] | None:
    if value is None:
        return None
    return {
        "id": value.id,
        "elapsed_s": number(value.elapsed),
        "duration_s": number(value.duration),
        "passes": number(value.passes),
        "passes_done": number(value.passes_done),
        "paused": value.paused,
        "mean_error_mm": scaled(value.mean_error, MILLI),
        "steps": value.steps,
        "sweeps": value.sweeps,
        "reversals": value.reversals,
    }


def camera(value: CameraTiming) -> dict[str, Any]:
    return {"latency_ms": scaled(value.latency, MILLI, 2), "rate_Hz": number(value.rate, 2)}


def loop(value: Timing) -> dict[str, Any]:
    return {
        "rate_Hz": number(value.rate, 2),
        "period_p99_ms": scaled(value.period_p99, MILLI, 3),
        "latency_p50_ms": scaled(value.latency_p50, MILLI, 3),
        "latency_p99_ms": scaled(value.latency_p99, MILLI, 3),
        "dropped_frames": value.dropped_frames,
    }


def link(value: LinkStatus) -> dict[str, Any]:
    return {
        "state": value.state,
        "port": value.port,
        "firmware": value.firmware,
        "boot_id": value.boot_id,
        "round_trip_ms": scaled(value.round_trip, MILLI, 3),
        "round_trip_median_ms": scaled(value.round_trip_median, MILLI, 3),
        "round_trip_p99_ms": scaled(value.round_trip_p99, MILLI, 3),
        "bad_frames": value.bad_frames,
        "bad_share": number(value.bad_share),
        "counts": link_counts(value.counts),
        "board_state": value.board_state,
        "board_faults": list(value.board_faults),
        "supply_V": number(value.supply, 2),
    }


def link_counts(value: LinkCounts) -> dict[str, Any]:
    return {
        "sent": value.sent,
        "received": value.received,
        "broken": dict(value.broken),
        "resends": value.resends,
        "reconnects": value.reconnects,
        "board_bad": value.board_bad,
        "refused": value.refused,
        "stale": value.stale,
    }


def recording(value: RecordingStatus) -> dict[str, Any]:
    return {
        "state": value.state,
        "run": value.run,
        "size_bytes": value.size,
        "ticks_waiting": value.ticks_waiting,
        "frames_left_out": value.frames_left_out,
        "failure": value.failure,
    }


def text(message: dict[str, Any]) -> str:
    """A message as JSON; a number that JSON does not have is a mistake of ours and raises ValueError."""
    return json.dumps(message, allow_nan=False, separators=(",", ":"))


class TickText:
    """The newest tick as JSON, made once for all clients that want it."""

    def __init__(self, operator: Callable[[], dict[str, Any] | None]) -> None:
        """operator: who has the rig's lease."""
        self._operator = operator
        self._snapshot: Snapshot | None = None
        self._text = ""

    def of(self, snapshot: Snapshot) -> str:
        if snapshot is not self._snapshot:
            self._text = text({"type": "tick", **state(snapshot, self._operator())})
            self._snapshot = snapshot
        return self._text
