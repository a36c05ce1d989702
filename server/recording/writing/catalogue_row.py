"""A run's row in the catalogue while the run is walked. Belongs to the recorder's writing thread.

The catalogue's trouble is no reason to stop anything: what it lacks is in the recording, and comes into it later.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping
from dataclasses import replace
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from control.runs import Run
from server.catalogue.edits import edits_beside
from server.catalogue.errors import CatalogueError, NoSuchRun
from server.metrics_json import metrics_json
from server.recording.conditions import Conditions, settings_json
from server.recording.presence import Presence
from server.recording.writing.row import record_of

if TYPE_CHECKING:
    from server.catalogue.catalogue import Catalogue

log = logging.getLogger(__name__)


class CatalogueRow:
    """Of one run. As long as it says that the run goes on, other programs can tell that it does."""

    def __init__(self, catalogue: Catalogue, folder: Path, conditions: Conditions) -> None:
        """folder: of the recordings."""
        self._catalogue = catalogue
        self._folder = folder
        self._conditions = conditions
        self._presence: Presence | None = None

    def begin(self, settings: Mapping[str, Any], *, has_file: bool) -> None:
        """settings: as in settings.json.  has_file: the lock of the recording tells that the run goes on."""
        id = settings["run"]["id"]
        if not has_file:
            self._presence = Presence(self._folder, id)
        state = "writing" if has_file else "none"
        self._try(id, lambda: self._catalogue.add(record_of(settings, state)))

    def change(self, run: Run) -> None:
        """Another selection."""
        chosen = settings_json(run, self._conditions)["run"]
        changes = {
            "controller": run.request.selection.controller.name,
            "trajectory": run.request.selection.trajectory.name,
            "selection": {part: chosen[part] for part in ("controller", "trajectory", "gait")},
        }
        self._try(run.id, lambda: self._catalogue.update(run.id, **changes))

    def end(self, run: Run, ended_at: datetime | None) -> None:
        """The run is over; its file is not."""
        self._try(run.id, lambda: self._catalogue.update(run.id, **_ending(run, ended_at)))

    def finish(self, run: Run, ended_at: datetime | None, of_file: Mapping[str, Any]) -> None:
        """All that there will be. of_file: fields of the row that the file tells."""
        self._try(run.id, lambda: self._complete(run, {**_ending(run, ended_at), **of_file}))
        if self._presence is not None:
            self._presence.close()

    def _complete(self, run: Run, all_there_is: Mapping[str, Any]) -> None:
        """Also where the catalogue did not take the beginning, or has been made anew since."""
        try:
            self._catalogue.update(run.id, **all_there_is)
        except NoSuchRun:
            record = record_of(settings_json(run, self._conditions), "none")
            self._catalogue.add(replace(record, **all_there_is, **edits_beside(self._folder, run.id)))

    def _try(self, id: str, change: Callable[[], object]) -> None:
        try:
            change()
        except CatalogueError as error:
            log.error("run %s: %s", id, error)


def _ending(run: Run, ended_at: datetime | None) -> dict[str, Any]:
    """How the run has ended."""
    return {"state": run.state.value, "reason": run.reason, "ended_at": ended_at, **_figures(run)}


def _figures(run: Run) -> dict[str, Any]:
    """Those that are known; a loop that hangs tells them when it comes back."""
    return {} if run.metrics is None else {"metrics": metrics_json(run.metrics)}


def add_figures(catalogue: Catalogue, run: Run) -> None:
    """Of a run that has ended before they were known."""
    try:
        catalogue.update(run.id, **_figures(run))
    except CatalogueError as error:
        log.error("run %s: %s", run.id, error)
