"""The sets of values that a design asks for, one after the other."""

from __future__ import annotations

from collections.abc import Sequence

from control.studies.axes import Scalar
from control.studies.consistency import number_of_sets
from control.studies.definition import StudyDefinition

Set = dict[str, Scalar | None]
"""Axis to value, lab units; None where a listed set leaves it at the definition's own."""


class Grid(Sequence[Set]):
    """Every combination; the last axis changes fastest. Made when it is asked for."""

    def __init__(self, definition: StudyDefinition) -> None:
        self._axes = [(axis.of, axis.choices or ()) for axis in definition.axes]
        self._count = number_of_sets(definition)

    def __len__(self) -> int:
        return self._count

    def __getitem__(self, number: int) -> Set:  # type: ignore[override]
        if not 0 <= number < self._count:
            raise IndexError(f"there is no set {number}; this grid has {self._count}")
        values: Set = {}
        for name, choices in reversed(self._axes):
            number, at = divmod(number, len(choices))
            values[name] = choices[at]
        return {name: values[name] for name, _ in self._axes}


def sets_of(definition: StudyDefinition) -> Sequence[Set]:
    """All sets of a grid, a list or a Latin hypercube, in the order of their numbers."""
    if definition.design == "list":
        return [{axis: one.get(axis) for axis in definition.axis_names} for one in definition.sets]
    if definition.design == "latin":
        return _latin(definition)
    return Grid(definition)


def _latin(definition: StudyDefinition) -> list[Set]:
    """One point in each of `sets` equal parts of every axis (McKay, Beckman and Conover 1979)."""
    from scipy.stats import qmc

    cube = qmc.LatinHypercube(len(definition.axes), rng=definition.seed).random(definition.latin.sets)
    return [
        {axis.of: axis.value(share) for axis, share in zip(definition.axes, point, strict=True)}
        for point in cube.tolist()
    ]
