"""The catalogue's row of a run, as its recording has it: for a catalogue that is rebuilt, and after a recovery."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from datetime import UTC, datetime
from typing import Any

from server.catalogue.records import INTERRUPTED, RUNNING, RunRecord
from server.recording.reading.recording import Recording
from server.recording.recovery.recount import number
from server.recording.writing.overview import spread
from server.recording.writing.row import record_of

REASON = "the program ended before the run did"
"""Of a run that was interrupted."""


def listed(id: str, recording: Recording) -> RunRecord:
    """id: by the file's name. Where the file does not tell something, it is as for any run."""
    outcome, metrics = recording.outcome or {}, (recording.outcome or {}).get("metrics")
    return replace(
        _beginning(id, recording),
        id=id,
        state=_state(outcome),
        reason=str(outcome.get("reason", REASON)),
        ended_at=_ended_at(outcome, recording),
        metrics=metrics if isinstance(metrics, dict) else None,
        recording_state="complete" if recording.is_whole and not recording.is_recovered else "recovered",
        size_bytes=recording.size,
        frames=int(number(outcome, "frames") or 0),
        sparkline=_sparkline(recording),
    )


def _beginning(id: str, recording: Recording) -> RunRecord:
    """What was known when the run began."""
    try:
        return record_of(recording.settings, "complete")
    except (KeyError, TypeError, ValueError):
        return RunRecord(id=id, started_at=recording.started_at)


def _state(outcome: Mapping[str, Any]) -> str:
    """A recording that was ended while its run went on is one of a program that ended."""
    state = outcome.get("state")
    return state if isinstance(state, str) and state != RUNNING else INTERRUPTED


def _ended_at(outcome: Mapping[str, Any], recording: Recording) -> datetime:
    try:
        ended = datetime.fromisoformat(str(outcome.get("ended_at")))
    except ValueError:
        return recording.ended_at
    return ended if ended.tzinfo is not None else ended.replace(tzinfo=UTC)


def _sparkline(recording: Recording) -> tuple[float, ...]:
    errors = (recording.overview or {}).get("error_mm")
    named = [{"error": error} for error in errors] if isinstance(errors, list) else []
    return spread(error for each in named if (error := number(each, "error")) is not None)
