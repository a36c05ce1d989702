"""The plan of a study: which run has which index, and which come next; a pure function of the definition.

A run's index says which set and repeat it is, never when it is done: index = repeat x sets + set. So more
repeats leave the runs that are there as they were, and its seed follows from its index alone.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import NDArray

from control.model import Pose
from control.runs import Selection
from control.simulation.plants import PlantChoice
from control.studies.design import sets_of
from control.studies.seeds import generator, run_seed
from control.studies.settings import Setup, settle
from control.studies.start import scattered, start_of
from control.studies.table import StudyRow

if TYPE_CHECKING:
    from control.studies.definition import StudyDefinition

ORDER_DRAW = 1
"""Purpose of the random numbers for the order; the starts' scatter has one of its own."""
ME = "normalized_mean_error"
FEWEST_REPEATS = 3
"""An interval of fewer runs says next to nothing (t = 12.7 at two)."""
CONFIDENCE = 0.95

Done = Mapping[int, StudyRow]
NOTHING: Done = {}


@dataclass(frozen=True, slots=True)
class PlannedRun:
    """One run to carry out. index, set, repeat: its place in the plan.  seed: of the plant.  values: axis to
    value, lab units.  passes: of the path.  duration: a cap, s.  start: where it starts, m, m, rad.
    """

    index: int
    set: int
    repeat: int
    seed: int
    values: Mapping[str, Any]
    selection: Selection
    passes: float = 1.0
    duration: float | None = None
    plant: PlantChoice = PlantChoice()
    start: Pose | None = None
    setup: Setup = Setup()


class Plan(Protocol):
    @property
    def total(self) -> int:
        """Runs at most."""
        ...

    @property
    def axes(self) -> tuple[str, ...]: ...

    def next(self, done: Done) -> Sequence[int]:
        """The runs to carry out next, in this order; none when the study is finished."""
        ...

    def run(self, index: int, done: Done = NOTHING) -> PlannedRun:
        """Raises IndexError for a run that is not in the plan."""
        ...


def plan_of(definition: StudyDefinition) -> Plan:
    if definition.design == "tune":
        from control.studies.tuning import TunePlan

        return TunePlan(definition)
    return FixedPlan(definition)


def planned_run(
    definition: StudyDefinition, index: int, set: int, repeat: int, values: Mapping[str, Any]
) -> PlannedRun:
    """values: lab units; None keeps the definition's own. Raises `StudyError` for values that cannot be."""
    settings = settle(definition, values)
    start = start_of(definition.start, settings.selection.build_trajectory())
    if definition.on == "batch":
        start = scattered(start, definition.start, definition.seed, index)
    return PlannedRun(
        index=index,
        set=set,
        repeat=repeat,
        seed=run_seed(definition.seed, index),
        values=dict(values),
        selection=settings.selection,
        passes=definition.passes,
        duration=definition.duration_s,
        plant=settings.plant,
        start=start,
        setup=settings.setup,
    )


class FixedPlan:
    """A grid, a list or a Latin hypercube."""

    def __init__(self, definition: StudyDefinition) -> None:
        self._definition = definition
        self.sets = sets_of(definition)
        self.total = len(self.sets) * definition.repeats
        self.axes = definition.axis_names

    def run(self, index: int, done: Done = NOTHING) -> PlannedRun:  # noqa: ARG002
        if not 0 <= index < self.total:
            raise IndexError(f"there is no run {index}; this study has {self.total}")
        repeat, number = divmod(index, len(self.sets))
        return planned_run(self._definition, index, number, repeat, self.sets[number])

    def next(self, done: Done) -> Sequence[int]:
        """All that is left; with a stop rule for sets, what is left of the first pass that is not complete."""
        if not self._definition.stop.half_width_percent:
            return [index for index in self._order().tolist() if index not in done]
        return self._left_to_be_known(done)

    def _left_to_be_known(self, done: Done) -> Sequence[int]:
        """Whether a set is known well enough follows from its repeats before the pass alone. Each row is read once."""
        sets = len(self.sets)
        unknown: dict[int, list[float]] = {number: [] for number in range(sets)}
        for repeat in range(self._definition.repeats):
            if any(repeat * sets + number not in done for number in unknown):
                return [
                    index
                    for index in self._pass(repeat).tolist()
                    if index % sets in unknown and index not in done
                ]
            for number, errors in unknown.items():
                row = done[repeat * sets + number]
                if row.state == "finished":
                    errors.append(row.metric(ME))
            unknown = {number: errors for number, errors in unknown.items() if not self._is_known(errors)}
        return []

    def _order(self) -> NDArray[np.int64]:
        """Every index once."""
        sets, repeats = len(self.sets), self._definition.repeats
        if self._definition.order == "random":
            return generator(self._definition.seed, 0, ORDER_DRAW).permutation(self.total)
        if self._definition.order == "listed":
            return np.arange(self.total).reshape(repeats, sets).T.ravel()
        return np.concatenate([self._pass(repeat) for repeat in range(repeats)])

    def _pass(self, repeat: int) -> NDArray[np.int64]:
        """One repeat of every set, shuffled: a drift of the rig falls on all sets alike."""
        sets = len(self.sets)
        return repeat * sets + generator(self._definition.seed, repeat, ORDER_DRAW).permutation(sets)

    def _is_known(self, errors: Sequence[float]) -> bool:
        return half_width(errors) <= self._definition.stop.half_width_percent / 100.0


def half_width(errors: Sequence[float]) -> float:
    """Half of the 95 % interval (Student's t) of the mean, as a share of the mean; inf for too few runs."""
    if len(errors) < FEWEST_REPEATS:
        return math.inf
    mean, deviation = float(np.mean(errors)), float(np.std(errors, ddof=1))
    if not (mean > 0.0 and math.isfinite(deviation)):
        return math.inf
    return _students(len(errors) - 1) * deviation / math.sqrt(len(errors)) / mean


@cache
def _students(freedom: int) -> float:
    """Half of the interval of Student's t, in standard errors; asked for by every set in every pass."""
    from scipy.stats import t

    return float(t.ppf(0.5 * (1.0 + CONFIDENCE), freedom))
