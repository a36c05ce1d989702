"""A run's row in the catalogue, from what its recording says of it."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import datetime
from typing import Any

from server.catalogue.records import RecordingState, RunRecord

LONG = ("reference_points_mm",)
"""Of the settings, what only the recording keeps."""


def record_of(settings: Mapping[str, Any], recording_state: RecordingState) -> RunRecord:
    """settings: those of settings.json. Raises KeyError, TypeError and ValueError for what nobody here wrote."""
    run = settings["run"]
    return RunRecord(
        id=run["id"],
        started_at=datetime.fromisoformat(run["started_at"]),
        label=run["label"],
        tags=tuple(run["tags"]),
        controller=run["controller"]["name"],
        trajectory=run["trajectory"]["name"],
        selection={part: run[part] for part in ("controller", "trajectory", "gait")},
        passes=run["passes"],
        duration_s=run["duration_s"],
        unattended=run["unattended"],
        simulated=settings["simulated"],
        plant=settings["plant"],
        seed=settings["seed"],
        rig=settings["rig"]["name"],
        version=settings["versions"]["pivotrig"],
        study=settings["study"],
        recording_state=recording_state,
        settings={name: value for name, value in settings.items() if name not in LONG},
    )
