"""A run of the catalogue as REST and the command line show it."""

from __future__ import annotations

from datetime import datetime
from typing import Any

from server.catalogue.records import RunRecord


def time_text(time: datetime) -> str:
    """A UTC time as the outside sees it, to the millisecond."""
    return time.isoformat(timespec="milliseconds").replace("+00:00", "Z")


def record_json(record: RunRecord) -> dict[str, Any]:
    """Without the settings."""
    return {
        "id": record.id,
        "label": record.label,
        "tags": list(record.tags),
        "notes": record.notes,
        "pinned": record.pinned,
        "state": record.state,
        "reason": record.reason,
        "started_at": time_text(record.started_at),
        "ended_at": None if record.ended_at is None else time_text(record.ended_at),
        "passes": record.passes,
        "duration_s": record.duration_s,
        "unattended": record.unattended,
        "controller": {"name": record.controller, "parameters": {}},
        "trajectory": {"name": record.trajectory, "parameters": {}},
        "gait": {},
        **record.selection,
        "metrics": record.metrics,
        "simulated": record.simulated,
        "plant": record.plant,
        "seed": record.seed,
        "rig": record.rig,
        "version": record.version,
        "study": record.study,
        "recording": {
            "state": record.recording_state,
            "size_bytes": record.size_bytes,
            "frames": record.frames,
        },
        "sparkline": list(record.sparkline),
    }
