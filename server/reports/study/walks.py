"""The paths of a few sets: which, and where they come from: walked once more, or read from recordings."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from control.studies.analysis.whole import Analysis
from control.studies.definition import StudyDefinition
from control.studies.table import StudyRow, StudyTable
from server.reports.drawing import MM
from server.reports.study.layout import spread
from server.reports.study.naming import point_text
from server.reports.study.trajectories import Walked

if TYPE_CHECKING:
    from control.studies.batch.plain import Step

SIDE = 2
"""Paths stand in a square of at most so many a side: each is walked once more, which is most of a report's time."""
RANKED = 3
LONGEST = 200.0
"""Simulated time of a run that is walked once more for its picture, s: about a second of computing."""

Source = Callable[[StudyRow, str], Walked | None]
"""From a finished row and the title of its set to its path; None where there is none."""


@dataclass(frozen=True, slots=True)
class Paths:
    """columns: how many stand side by side."""

    walks: tuple[Walked, ...]
    columns: int


def paths(found: Analysis, table: StudyTable, source: Source) -> Paths | None:
    """The first finished run of each chosen set."""
    places, columns = chosen_sets(found)
    walks = []
    for place in places:
        row = _first(table, found.samples.sets[place])
        point = dict(zip(found.samples.axes, found.samples.points[place], strict=True))
        title = point_text({axis: point[axis] for axis in found.samples.varied()}) or "the set"
        walk = None if row is None else source(row, title)
        if walk is not None:
            walks.append(walk)
    return Paths(tuple(walks), min(columns, len(walks))) if walks else None


def chosen_sets(found: Analysis) -> tuple[list[int], int]:
    """Rows of the sets in samples.points, and how many stand side by side.

    Of a grid: the ends of the two axes with the fewest levels, the others as in the best set, as in the
    paper's figures. Else the best, the middle and the worst set.
    """
    samples = found.samples
    axes = sorted(samples.varied(), key=lambda axis: len(samples.levels(axis)))[:2]
    if found.best is None:
        return [], 1
    if samples.scattered or len(axes) < 2:
        return _ranked(found), RANKED
    across, up = (spread(samples.levels(axis), SIDE) for axis in axes)
    at = {point: place for place, point in enumerate(samples.points)}
    wanted = [
        tuple({**found.best.values, axes[0]: right, axes[1]: high}[axis] for axis in samples.axes)
        for high in up
        for right in across
    ]
    return [at[point] for point in wanted if point in at], len(across)


def _ranked(found: Analysis) -> list[int]:
    """The best set, that in the middle, and the worst; all of them where there are few."""
    places = [place for place, one in enumerate(found.summaries) if one.runs]
    places.sort(key=lambda place: found.summaries[place].mean.value)
    return spread(places, RANKED)


def _first(table: StudyTable, number: int) -> StudyRow | None:
    rows = [row for row in table.rows if row.set == number and row.state == "finished"]
    return min(rows, key=lambda row: row.repeat, default=None)


@dataclass(frozen=True, slots=True)
class WalkedAgain:
    """Walks a batch's run once more: the same seed, so the same path."""

    definition: StudyDefinition

    def __call__(self, row: StudyRow, title: str) -> Walked | None:
        from control.studies.batch import plain_walk
        from control.studies.plan import planned_run

        if not row.metric("duration_s") <= LONGEST:
            return None
        run = planned_run(self.definition, row.index, row.set, row.repeat, row.values)
        steps: list[Step] = []
        plain_walk(run, steps.append)
        reference = np.array([step.reference for step in steps])
        centre = np.array([(step.pose.x, step.pose.y) for step in steps])
        return Walked(title, reference, centre, row.metric("normalized_mean_error"))


@dataclass(frozen=True, slots=True)
class Recorded:
    """Reads a rig's runs. folder: of the recordings."""

    folder: Path

    def __call__(self, row: StudyRow, title: str) -> Walked | None:
        """None for a run whose recording is gone or cannot be read."""
        from server.catalogue.shelf import file_of
        from server.exports.run_figure import walked
        from server.recording.reading.recording import Recording, Unreadable

        try:
            with Recording.open(file_of(self.folder, row.run_id)) as recording:
                run = walked(recording, lambda _: None)
        except (OSError, Unreadable):
            return None
        known = np.isfinite(run.x_reference) & np.isfinite(run.x)
        if not np.any(known):
            return None
        reference = np.stack([run.x_reference, run.y_reference], axis=1)[known] * MM
        centre = np.stack([run.x, run.y], axis=1)[known] * MM
        return Walked(title, reference, centre, row.metric("normalized_mean_error"))


def source_of(definition: StudyDefinition, recordings: Path | None) -> Source | None:
    """Where the paths of a study come from; None for a rig's whose recordings are not at hand."""
    if definition.on == "batch":
        return WalkedAgain(definition)
    return None if recordings is None else Recorded(recordings)
