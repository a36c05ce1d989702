"""Which axes of a study go where in its figures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeVar

from control.studies.analysis.samples import Samples

T = TypeVar("T")
MOST_PANELS = 9
MOST_LINES = 8
TILT, SWEEP, STEP = "gait.tilt_deg", "gait.sweep_deg", "gait.path_step_s"


@dataclass(frozen=True, slots=True)
class Layout:
    """x: the axis below.  line: one line for each of its values.  panel: one panel for each.
    averaged: the axes that are not shown."""

    x: str
    line: str | None
    panel: str | None
    averaged: tuple[str, ...]


def line_layouts(samples: Samples) -> tuple[Layout, ...]:
    """One for each numeric axis, and the paper's third figure where the study has the paper's axes."""
    varied = samples.varied()
    numeric = [axis for axis in varied if samples.numeric(axis)]
    layouts = [_lines(samples, axis) for axis in numeric or varied]
    paper = Layout(TILT, SWEEP, STEP, tuple(axis for axis in varied if axis not in (TILT, SWEEP, STEP)))
    if {TILT, SWEEP, STEP} <= set(numeric) and paper not in layouts:
        layouts.append(paper)
    return tuple(layouts)


def _lines(samples: Samples, x: str) -> Layout:
    """Words first, then the axes with the fewest levels: few lines are easy to tell apart, panels may be many."""
    others = sorted(
        (axis for axis in samples.varied() if axis != x),
        key=lambda axis: (samples.numeric(axis), len(samples.levels(axis))),
    )
    return Layout(x, _at(others, 0), _at(others, 1), tuple(others[2:]))


def heat_layout(samples: Samples) -> Layout | None:
    """x and line are the two axes of the map: numbers with the most levels; None for fewer than two axes."""
    varied = sorted(
        samples.varied(), key=lambda axis: (not samples.numeric(axis), -len(samples.levels(axis)))
    )
    if len(varied) < 2:
        return None
    return Layout(varied[0], varied[1], _at(varied, 2), tuple(varied[3:]))


def _at(names: list[str], place: int) -> str | None:
    return names[place] if place < len(names) else None


def spread(items: Sequence[T], most: int) -> list[T]:
    """At most so many, the first and the last among them, evenly chosen."""
    if len(items) <= most:
        return list(items)
    return [items[round(k * (len(items) - 1) / (most - 1))] for k in range(most)]
