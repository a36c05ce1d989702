"""Whether the parts of a definition fit each other; each complaint is one line in words."""

from __future__ import annotations

import math
from collections import Counter
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from control.studies.definition import StudyDefinition


def check(definition: StudyDefinition) -> None:
    """Raises ValueError with the first thing that does not fit."""
    for look in (_design, _axes, _order, _subjects, _tuning, _size):
        complaint = look(definition)
        if complaint:
            raise ValueError(complaint)


def _design(definition: StudyDefinition) -> str:
    if definition.design == "list":
        if definition.axes:
            return 'a study of design "list" names its values in [[sets]]; leave [[axes]] out'
        return _listed(definition)
    if definition.sets:
        return f'[[sets]] belong to design = "list", not "{definition.design}"'
    if definition.design in ("latin", "tune") and not definition.axes:
        return f'a study of design "{definition.design}" needs at least one [[axes]] table'
    return ""


def _listed(definition: StudyDefinition) -> str:
    if not definition.sets:
        return 'a study of design "list" needs at least one [[sets]] table'
    seen: dict[frozenset[tuple[str, object]], int] = {}
    for number, one in enumerate(definition.sets):
        first = seen.setdefault(frozenset((axis, (type(v), v)) for axis, v in one.items()), number)
        if first != number:
            return f"sets {first} and {number} are the same; ask for more repeats instead"
    return ""


def _axes(definition: StudyDefinition) -> str:
    twice = [name for name, count in Counter(axis.of for axis in definition.axes).items() if count > 1]
    if twice:
        return f"the axis {twice[0]} is there twice; give each axis once, with all of its values"
    for axis in definition.axes:
        if axis.choices is None and definition.design == "grid":
            return f"the axis {axis.of} needs a step: a grid takes single values"
        if axis.choices is None and axis.first == axis.last:
            return f"the axis {axis.of} goes from {axis.first} to {axis.last}: a range needs two ends"
    return ""


def _order(definition: StudyDefinition) -> str:
    if definition.stop.half_width_percent and (definition.order != "blocked" or definition.design == "tune"):
        return (
            'stop.half_width_percent needs order = "blocked" and a design other than tune: '
            "whether a set is known well enough is decided after each whole pass"
        )
    return ""


def _subjects(definition: StudyDefinition) -> str:
    if definition.on == "batch":
        return ""
    for name in definition.axis_names:
        if name.partition(".")[0] in ("plant", "setup"):
            return f'{name} can only be varied in a batch (on = "batch"): a rig has its own robot and board'
    return ""


def _tuning(definition: StudyDefinition) -> str:
    tune = definition.tune
    if definition.design == "tune" and not tune.first * definition.repeats + tune.confirm <= tune.budget:
        return (
            f"tune.budget is {tune.budget} runs, but the first {tune.first} points x {definition.repeats} repeats "
            f"and the {tune.confirm} runs of the confirmation already take "
            f"{tune.first * definition.repeats + tune.confirm}"
        )
    return ""


def _size(definition: StudyDefinition) -> str:
    from control.studies.definition import MOST_RUNS, MOST_SETS

    sets = number_of_sets(definition)
    if not sets <= MOST_SETS:
        return f'{sets} sets; at most {MOST_SETS} are allowed: give fewer values, or use design = "latin"'
    if not sets * definition.repeats <= MOST_RUNS:
        return (
            f"{sets} sets x {definition.repeats} repeats are more than the {MOST_RUNS} runs that are allowed"
        )
    return ""


def number_of_sets(definition: StudyDefinition) -> int:
    """Different sets of values; of a tuning at most so many."""
    if definition.design == "list":
        return len(definition.sets)
    if definition.design == "latin":
        return definition.latin.sets
    if definition.design == "tune":
        return max(1, (definition.tune.budget - definition.tune.confirm) // definition.repeats)
    return math.prod(len(axis.choices or ()) for axis in definition.axes)
