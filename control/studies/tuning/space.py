"""What may be tuned: the axes of a study as points of the unit cube, and back to the lab's values.

An axis is a range (proposals are rounded to what a person would type), a lattice (a range with a step, or a
list of numbers), or a choice between words. A number is one coordinate; a choice is one coordinate a word,
so that no word is nearer to a second than to a third.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from control.studies.axes import Axis as StudyAxis
from control.studies.axes import whole_as_int
from control.studies.definition import StudyDefinition

Floats = NDArray[np.float64]

Point = tuple[tuple[str, Any], ...]
"""One set of values by axis, lab units, in the order of the axes' names: equal where the sets are."""

FINENESS = 200
"""A range is told apart in at least so many parts: far finer than any run's scatter can tell."""

WORDS_APART = 1 / math.sqrt(2)
"""Coordinate of the chosen word: two different words are then 1 apart, like the two ends of a range."""


class Axis(Protocol):
    """One axis: `width` coordinates of the cube."""

    @property
    def name(self) -> str: ...
    @property
    def width(self) -> int: ...
    def value(self, share: float) -> Any:
        """The lab's value at this share, 0-1, of the axis."""
        ...

    def share(self, value: Any) -> float:
        """The share of the axis, 0-1, that gives this value."""
        ...

    def place(self, value: Any) -> tuple[float, ...]:
        """The coordinates of a value, each 0-1."""
        ...

    def marks(self, most: int) -> list[Any]:
        """At most so many values in order over the whole axis, to draw it."""
        ...


@dataclass(frozen=True, slots=True)
class Range:
    """Every number from low to high, lab units."""

    name: str
    low: float
    high: float

    width = 1

    def value(self, share: float) -> float:
        decimals = -math.floor(math.log10((self.high - self.low) / FINENESS))
        number = round(self.low + share * (self.high - self.low), decimals)
        return whole_as_int(min(max(number, self.low), self.high))

    def share(self, value: Any) -> float:
        return (float(value) - self.low) / (self.high - self.low)

    def place(self, value: Any) -> tuple[float, ...]:
        return (self.share(value),)

    def marks(self, most: int) -> list[Any]:
        return [self.low + (self.high - self.low) * k / (most - 1) for k in range(most)]


@dataclass(frozen=True, slots=True)
class Lattice:
    """These numbers only, ascending, lab units."""

    name: str
    numbers: tuple[Any, ...]

    width = 1

    def value(self, share: float) -> Any:
        return self.numbers[_slot(share, len(self.numbers))]

    def share(self, value: Any) -> float:
        return (self.numbers.index(value) + 0.5) / len(self.numbers)

    def place(self, value: Any) -> tuple[float, ...]:
        low, high = float(self.numbers[0]), float(self.numbers[-1])
        return ((float(value) - low) / (high - low) if high > low else 0.5,)

    def marks(self, most: int) -> list[Any]:
        return _thinned(self.numbers, most)


@dataclass(frozen=True, slots=True)
class Words:
    """A choice between things without an order, such as controllers."""

    name: str
    words: tuple[Any, ...]

    @property
    def width(self) -> int:
        return len(self.words)

    def value(self, share: float) -> Any:
        return self.words[_slot(share, len(self.words))]

    def share(self, value: Any) -> float:
        return (self.words.index(value) + 0.5) / len(self.words)

    def place(self, value: Any) -> tuple[float, ...]:
        return tuple(WORDS_APART if word == value else 0.0 for word in self.words)

    def marks(self, most: int) -> list[Any]:
        return list(self.words[:most])


@dataclass(frozen=True, slots=True)
class Space:
    """All axes of a study that are tuned."""

    axes: tuple[Axis, ...]

    def point(self, shares: Iterable[float]) -> Point:
        """shares: one an axis, 0-1."""
        values = {axis.name: axis.value(float(share)) for axis, share in zip(self.axes, shares, strict=True)}
        return point_of(values)

    def values(self, point: Point) -> dict[str, Any]:
        """By axis, in the order of the axes; lab units."""
        values = dict(point)
        return {axis.name: values[axis.name] for axis in self.axes}

    def shares(self, point: Point) -> Floats:
        """One an axis, 0-1."""
        values = dict(point)
        return np.array([axis.share(values[axis.name]) for axis in self.axes])

    def places(self, points: Sequence[Point]) -> Floats:
        """(points, coordinates)."""
        rows = [self._place(dict(point)) for point in points]
        return np.array(rows, dtype=float).reshape(len(points), self.coordinates)

    def _place(self, values: Mapping[str, Any]) -> list[float]:
        return [coordinate for axis in self.axes for coordinate in axis.place(values[axis.name])]

    @property
    def coordinates(self) -> int:
        return sum(axis.width for axis in self.axes)


def point_of(values: Mapping[str, Any]) -> Point:
    return tuple(sorted(values.items()))


def _slot(share: float, count: int) -> int:
    return min(max(int(share * count), 0), count - 1)


def _thinned(values: Sequence[Any], most: int) -> list[Any]:
    if len(values) <= most:
        return list(values)
    return [values[round(k * (len(values) - 1) / (most - 1))] for k in range(most)]


def space_of(definition: StudyDefinition) -> Space:
    return Space(tuple(_axis(axis) for axis in definition.axes))


def _axis(axis: StudyAxis) -> Axis:
    choices = axis.choices
    if choices is None:
        assert axis.first is not None and axis.last is not None  # noqa: PT018
        return Range(axis.of, axis.first, axis.last)
    if all(isinstance(choice, int | float) and not isinstance(choice, bool) for choice in choices):
        return Lattice(axis.of, tuple(sorted(choices, key=float)))
    return Words(axis.of, tuple(choices))
