"""What the catalogue knows of one run, what it can be asked for, and what it answers."""

from __future__ import annotations

from dataclasses import dataclass, field
from datetime import UTC, datetime
from typing import Any, Literal

INTERRUPTED = "interrupted"
"""State of a run whose program ended before the run did; the other states are those of `control.runs.RunState`."""
RUNNING = "running"

RecordingState = Literal["none", "writing", "complete", "recovered", "lost"]
"""none: there never was a file.  lost: there was one, and nothing of it can be read, or it is gone."""

POINTS_IN_SPARKLINE = 60
BEGINNING = datetime(1970, 1, 1, tzinfo=UTC)


@dataclass(frozen=True, slots=True)
class RunRecord:
    """One run. Names and units are those of the REST interface, since this is what it shows.

    started_at, ended_at: aware, UTC.  controller, trajectory: names.  selection: as `selection_json` gives it.
    duration_s: the cap that was asked for.  metrics: as `metrics_json` gives them, None before the end.
    sparkline: up to 60 errors over the run, mm.  settings: what made the run; only `Catalogue.get` reads it.
    """

    id: str
    started_at: datetime
    state: str = RUNNING
    reason: str = ""
    ended_at: datetime | None = None
    label: str = ""
    tags: tuple[str, ...] = ()
    notes: str = ""
    pinned: bool = False
    controller: str = ""
    trajectory: str = ""
    selection: dict[str, Any] = field(default_factory=dict)
    passes: float = 1.0
    duration_s: float | None = None
    unattended: bool = False
    metrics: dict[str, Any] | None = None
    simulated: bool = True
    plant: str = ""
    seed: int | None = None
    rig: str = ""
    version: str = ""
    study: str = ""
    recording_state: RecordingState = "none"
    size_bytes: int = 0
    frames: int = 0
    sparkline: tuple[float, ...] = ()
    settings: dict[str, Any] = field(default_factory=dict)

    @property
    def is_going_on(self) -> bool:
        """It walks, or its recording is still being written."""
        return self.state == RUNNING or self.recording_state == "writing"


@dataclass(frozen=True, slots=True)
class RunQuery:
    """Which runs are wanted; what is None or empty does not matter.

    text: words that all occur in label, id, notes, tags, controller or trajectory.  since <= started_at < until.
    """

    state: str = ""
    controller: str = ""
    trajectory: str = ""
    tag: str = ""
    study: str = ""
    text: str = ""
    simulated: bool | None = None
    pinned: bool | None = None
    since: datetime | None = None
    until: datetime | None = None


EVERY_RUN = RunQuery()


@dataclass(frozen=True, slots=True)
class Page:
    """runs: newest first, without their settings.  next: cursor of the following page, if there is one.

    total: all runs that the query finds.
    """

    runs: tuple[RunRecord, ...]
    next: str | None
    total: int


@dataclass(frozen=True, slots=True)
class Loose:
    """What decides whether a run that is not pinned is kept."""

    id: str
    label: str
    started_at: datetime
    size_bytes: int


@dataclass(frozen=True, slots=True)
class Totals:
    """Of the whole catalogue. size, pinned_size: bytes of recordings."""

    runs: int
    size: int
    pinned_size: int


@dataclass(frozen=True, slots=True)
class StudyRecord:
    """One study as it is listed; its folder knows the rest. definition: in lab units.  created_at: aware, UTC."""

    id: str
    name: str
    definition: dict[str, Any]
    state: str
    created_at: datetime
