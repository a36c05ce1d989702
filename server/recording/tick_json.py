"""A recorded tick in the shape that the page lives on: the names of `server.api.ticks.state`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from control.snapshot import NOT_RECORDED
from server.api.ticks import recording

Message = Mapping[str, Any]
NOTHING: Message = {}


def as_tick(messages: Mapping[str, Message]) -> dict[str, Any]:
    """messages: those of one tick by topic. What is not known is null; every digit is kept."""
    state = messages.get("/state", NOTHING)
    timing = messages.get("/timing", NOTHING)
    limited_by = state.get("limited_by", "")
    return {
        "rig": state.get("rig"),
        "reason": state.get("reason", ""),
        "faults": [_some(fault, "code", "message", "since_s") for fault in state.get("faults", ())],
        **_some(state, "simulated", "tick", "time_s", "captured_s", "tracking"),
        "tracking_reason": state.get("tracking_reason", ""),
        "tracking_age_s": state.get("tracking_age_s"),
        "error_mm": messages.get("/reference", NOTHING).get("error_mm"),
        "saturated": bool(limited_by),
        "limited_by": limited_by,
        "refused": {what: state.get(f"refused_{what}", 0) for what in ("frames", "sightings", "reports")},
        "body_tilt_deg": state.get("body_tilt_deg"),
        **_robot(messages),
        **_sighting(messages.get("/measurement")),
        **_coils(messages),
        "command": _some(
            messages.get("/command", NOTHING),
            *("controller", "pivot", "rate_deg_s", "heading_goal_deg", "tilt_deg", "field_mT"),
        ),
        "run": _run(state.get("run")),
        "camera": {
            "latency_ms": timing.get("camera_latency_ms"),
            "rate_Hz": timing.get("camera_rate_Hz"),
        },
        "loop": _some(
            timing, "rate_Hz", "period_p99_ms", "latency_p50_ms", "latency_p99_ms", "dropped_frames"
        ),
        "link": _link(messages.get("/link", NOTHING)),
        "recording": recording(NOT_RECORDED),
        "operator": None,
    }


def _some(message: Message, *names: str) -> dict[str, Any]:
    return {name: message.get(name) for name in names}


def _robot(messages: Mapping[str, Message]) -> dict[str, Any]:
    estimate, reference = messages.get("/estimate"), messages.get("/reference")
    sigma = estimate or NOTHING
    return {
        "pose": None if estimate is None else _some(estimate, "x_mm", "y_mm", "heading_deg"),
        "pose_sigma": {name: sigma.get(f"sigma_{name}", 0.0) for name in ("x_mm", "y_mm", "heading_deg")},
        "reference": None if reference is None else _some(reference, "x_mm", "y_mm"),
    }


def _sighting(message: Message | None) -> dict[str, Any]:
    if message is None:
        return {"measurement": None, "window_px": None, "rivals_px": []}
    window = message.get("window_px")
    return {
        "measurement": _measurement(message) if "x_mm" in message else None,
        "window_px": None if window is None else list(window),
        "rivals_px": _pairs(message.get("rivals_px", ())),
    }


def _measurement(message: Message) -> dict[str, Any]:
    return {
        **_some(message, "x_mm", "y_mm", "heading_deg"),
        "centre_px": list(message.get("centre_px", ())),
        "corners_px": _pairs(message.get("corners_px", ())),
    }


def _pairs(flat: Sequence[float]) -> list[list[float]]:
    """u, v of each point in turn, as points."""
    return [list(pair) for pair in zip(flat[::2], flat[1::2], strict=False)]


def _coils(messages: Mapping[str, Message]) -> dict[str, Any]:
    currents = messages.get("/currents", NOTHING)
    return {
        "currents_A": currents.get("commanded_A"),
        "measured_currents_A": currents.get("measured_A"),
        "field_mT": messages.get("/field", NOTHING).get("field_mT"),
        "coil_heat": messages.get("/state", NOTHING).get("coil_heat"),
    }


def _run(run: Message | None) -> dict[str, Any] | None:
    if run is None:
        return None
    return _some(
        run,
        *("id", "elapsed_s", "duration_s", "passes", "passes_done"),
        *("paused", "mean_error_mm", "steps", "sweeps", "reversals"),
    )


def _link(link: Message) -> dict[str, Any]:
    counted = ("sent", "received", "resends", "reconnects", "board_bad", "refused", "stale")
    broken = {each.get("what"): each.get("count") for each in link.get("broken", ())}
    return {
        **_some(link, "state", "port", "firmware", "boot_id"),
        **_some(link, "round_trip_ms", "round_trip_median_ms", "round_trip_p99_ms"),
        **_some(link, "bad_frames", "bad_share"),
        "counts": {**_some(link, *counted), "broken": broken},
        **_some(link, "board_state", "board_faults", "supply_V"),
    }
