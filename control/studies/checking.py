"""A look at every set of a study before it starts: which cannot be carried out and why, and how long it will take."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from control.gait import Gait
from control.model import Pose
from control.runs import Choice
from control.simulation.plants import MissingExtra, PlantChoice, build_plant
from control.studies.axes import Axis
from control.studies.consistency import number_of_sets
from control.studies.definition import StudyDefinition
from control.studies.design import sets_of
from control.studies.errors import StudyError
from control.studies.settings import Settings, settle
from control.studies.start import start_of
from control.trajectories import Trajectory, check_inside, trajectories
from control.trajectories.arc_length import ArcLength
from control.trajectories.time_law import law_of

MOST_NAMED = 5
"""Bad sets that are named one by one; the rest are counted."""
MOST_CORNERS = 1024
"""Corners of what is tuned that are looked at; beyond, each axis is looked at by itself."""
MOST_PATHS = 100
"""Paths that are kept while the sets are looked at; 64 kB each."""


@dataclass(frozen=True, slots=True)
class Survey:
    """sets, runs: at most.  walking: rig time of all runs, s, without waiting for the robot.  resting: between the
    runs on a rig, s, without the ways back to the start.  problems: one text for each of the first bad sets.
    """

    sets: int
    runs: int
    walking: float
    resting: float
    problems: tuple[str, ...]


def check(definition: StudyDefinition, workspace: float | None = None) -> Survey:
    """Raises `StudyError` when any set cannot be carried out. workspace: as in `survey`."""
    found = survey(definition, workspace)
    if found.problems:
        raise StudyError("\n".join(found.problems))
    return found


def survey(definition: StudyDefinition, workspace: float | None = None) -> Survey:
    """workspace: of the rig, half the side of the square, m; None for the one in `[setup]`."""
    look = _Look(definition, workspace)
    problems: list[str] = []
    times: list[float] = []
    for number, values in _examined(definition):
        try:
            times.append(look.walking(values))
        except StudyError as error:
            problems.append(f"{_named(number, values)}: {error}")
    runs = runs_at_most(definition)
    return Survey(
        sets=number_of_sets(definition),
        runs=runs,
        walking=runs * math.fsum(times) / len(times) if times else 0.0,
        resting=runs * definition.rig.rest_s if definition.on == "rig" else 0.0,
        problems=_shortened(problems),
    )


def runs_at_most(definition: StudyDefinition) -> int:
    if definition.design == "tune":
        return definition.tune.budget
    return number_of_sets(definition) * definition.repeats


class _Look:
    """Looks at one set after the other; what several sets share is looked at once."""

    def __init__(self, definition: StudyDefinition, workspace: float | None) -> None:
        self._definition = definition
        self._workspace = workspace
        self._paths: dict[str, ArcLength] = {}
        self._inside: set[tuple[str, float]] = set()
        self._times: dict[tuple[str, Gait], float] = {}
        self._plants: set[str] = set()

    def walking(self, values: Mapping[str, Any]) -> float:
        """Rig time of one run, s; raises `StudyError`."""
        settings = settle(self._definition, values)
        half = settings.setup.workspace if self._workspace is None else self._workspace
        self._check_path(settings.selection.trajectory, half)
        if self._definition.on == "batch":
            self._check_plant(settings.plant)
        return self._time(settings)

    def _path(self, choice: Choice) -> ArcLength:
        key = repr(choice)
        if key not in self._paths:
            if len(self._paths) >= MOST_PATHS:
                self._paths.clear()
            self._paths[key] = ArcLength(_built(choice))
        return self._paths[key]

    def _check_path(self, choice: Choice, half: float) -> None:
        if (repr(choice), half) in self._inside:
            return
        path = self._path(choice).path
        try:
            check_inside(path, half)
        except ValueError as error:
            raise StudyError(f"trajectory {choice.name}: {error}") from None
        start = start_of(self._definition.start, path)
        if not max(abs(start.x), abs(start.y)) <= half:
            raise StudyError(
                f"the start at ({start.x * 1e3:.1f}, {start.y * 1e3:.1f}) mm is outside the workspace, "
                f"which ends at ±{half * 1e3:.0f} mm"
            )
        self._inside.add((repr(choice), half))

    def _check_plant(self, choice: PlantChoice) -> None:
        """One robot of each sort is built, which says whether what it needs is installed."""
        if choice.name in self._plants:
            return
        try:
            build_plant(choice, 0.010, Pose(0.0, 0.0, 0.0))
        except MissingExtra as error:
            raise StudyError(str(error)) from None
        self._plants.add(choice.name)

    def _time(self, settings: Settings) -> float:
        gait, choice = settings.selection.gait, settings.selection.trajectory
        key = (repr(choice), gait)
        if key not in self._times:
            self._times[key] = law_of(gait, self._path(choice), self._definition.passes).whole
        cap = self._definition.duration_s
        return self._times[key] if cap is None else min(cap, self._times[key])


def _built(choice: Choice) -> Trajectory:
    try:
        return trajectories.build(choice.name, choice.parameters)
    except ValueError as error:
        raise StudyError(f"trajectory {choice.name}: {error}") from None


def _examined(definition: StudyDefinition) -> Iterator[tuple[int | None, Mapping[str, Any]]]:
    """Every set with its number; of a tuning the corners of its axes."""
    if definition.design != "tune":
        yield from enumerate(sets_of(definition))
        return
    ends = {axis.of: _ends(axis) for axis in definition.axes}
    if math.prod(len(values) for values in ends.values()) <= MOST_CORNERS:
        for corner in itertools.product(*ends.values()):
            yield None, dict(zip(ends, corner, strict=True))
        return
    first = {name: values[0] for name, values in ends.items()}
    for name, values in ends.items():
        for value in values:
            yield None, {**first, name: value}


def _ends(axis: Axis) -> tuple[Any, ...]:
    """Both ends of a range; every name of a choice."""
    choices = axis.choices
    if choices is None:
        return axis.first, axis.last
    if all(isinstance(value, int | float) and not isinstance(value, bool) for value in choices):
        return tuple(dict.fromkeys((choices[0], choices[-1])))
    return choices


def _named(number: int | None, values: Mapping[str, Any]) -> str:
    given = ", ".join(f"{axis} = {value}" for axis, value in values.items() if value is not None)
    what = "the set" if number is None else f"set {number}"
    return f"{what} ({given})" if given else what


def _shortened(problems: list[str]) -> tuple[str, ...]:
    more = len(problems) - MOST_NAMED
    return (*problems[:MOST_NAMED], *([f"and {more} more sets of this study"] if more > 0 else []))
