"""One metric of all runs of a study, with the set in which each was measured."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

ME = "normalized_mean_error"
"""The paper's ME: mean distance from the reference over the length of the robot."""

MOST_LEVELS = 15
"""An axis with more levels is one of scattered points, as of a Latin hypercube or a search."""
FILLED = 0.5
"""A design with fewer sets than this share of all combinations of its levels is scattered, not a grid."""


class Row(Protocol):
    """What is read of a row of a study's table; metrics and values by their names, lab units."""

    @property
    def index(self) -> int: ...
    @property
    def set(self) -> int: ...
    @property
    def state(self) -> str: ...
    @property
    def metrics(self) -> Mapping[str, Any]: ...
    @property
    def values(self) -> Mapping[str, Any]: ...


@dataclass(frozen=True, slots=True)
class Samples:
    """metric: its name.  axes: names of the study's axes.  sets: number of each set in the plan, ascending.
    points: the sets' values of the axes, shape (sets, axes), lab units.
    place: (n,) for each run its row in `points`.  index: (n,) its index in the plan.
    value: (n,) the metric, NaN where the run failed or has no such figure.
    """

    metric: str
    axes: tuple[str, ...]
    sets: tuple[int, ...]
    points: tuple[tuple[Any, ...], ...]
    place: NDArray[np.int64]
    index: NDArray[np.int64]
    value: NDArray[np.float64]

    def of_set(self, place: int) -> NDArray[np.float64]:
        """The finished runs' values of one set, by its row in `points`."""
        values = self.value[self.place == place]
        return values[np.isfinite(values)]

    def groups(self) -> list[NDArray[np.float64]]:
        """`of_set` of every set."""
        return [self.of_set(place) for place in range(len(self.points))]

    def column(self, axis: str) -> list[Any]:
        """Each set's value of one axis."""
        at = self.axes.index(axis)
        return [point[at] for point in self.points]

    def levels(self, axis: str) -> list[Any]:
        """The different values of an axis, numbers first, ascending."""
        return sorted(set(self.column(axis)), key=lambda value: (not is_number(value), _sortable(value)))

    def numeric(self, axis: str) -> bool:
        return all(is_number(value) for value in self.column(axis))

    def varied(self) -> tuple[str, ...]:
        """The axes that take more than one value."""
        return tuple(axis for axis in self.axes if len(self.levels(axis)) > 1)

    @property
    def scattered(self) -> bool:
        """Whether the sets are no grid."""
        varied = self.varied()
        levels = [len(self.levels(axis)) for axis in varied]
        if any(count > MOST_LEVELS for count in levels):
            return True
        return len(varied) > 1 and len(self.points) < FILLED * math.prod(levels)

    def numbers(self, axis: str) -> NDArray[np.float64]:
        """Each set's value of a numeric axis."""
        return np.array(self.column(axis), dtype=float)

    def only(self, wanted: Mapping[str, Any]) -> Samples:
        """The runs of the sets with these values."""
        at = [self.axes.index(axis) for axis in wanted]
        kept = [
            place
            for place, point in enumerate(self.points)
            if [point[column] for column in at] == list(wanted.values())
        ]
        return self.chosen(kept)

    def chosen(self, places: Sequence[int]) -> Samples:
        """Only these sets, by their rows in `points`."""
        runs = np.isin(self.place, places)
        new = {place: at for at, place in enumerate(places)}
        return Samples(
            self.metric,
            self.axes,
            tuple(self.sets[place] for place in places),
            tuple(self.points[place] for place in places),
            np.array([new[int(place)] for place in self.place[runs]], dtype=np.int64),
            self.index[runs],
            self.value[runs],
        )


def is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _sortable(value: Any) -> Any:
    return value if is_number(value) else str(value)


def samples(rows: Iterable[Row], axes: Sequence[str], metric: str = ME) -> Samples:
    """rows: of a study's table, in any order; they are taken by their index."""
    ordered = sorted(rows, key=lambda row: row.index)
    values = {row.set: tuple(_hashable(row.values.get(axis)) for axis in axes) for row in ordered}
    sets = tuple(sorted(values))
    at = {number: place for place, number in enumerate(sets)}
    return Samples(
        metric,
        tuple(axes),
        sets,
        tuple(values[number] for number in sets),
        np.array([at[row.set] for row in ordered], dtype=np.int64),
        np.array([row.index for row in ordered], dtype=np.int64),
        np.array([_figure(row, metric) for row in ordered], dtype=float),
    )


def _figure(row: Row, metric: str) -> float:
    value = row.metrics.get(metric) if row.state == "finished" else None
    return float(value) if value is not None and is_number(value) else math.nan


def _hashable(value: Any) -> Any:
    """A list or table as a value of an axis (waypoints, say) is told by its text."""
    return value if isinstance(value, str | int | float | bool) or value is None else str(value)
