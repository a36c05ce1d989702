"""Lines of a metric over one axis, a line for each value of another, a panel for each value of a third."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from control.studies.analysis.intervals import Interval, mean_of_means
from control.studies.analysis.samples import Samples


@dataclass(frozen=True, slots=True)
class Curve:
    """value: the line's own value of its axis.  x: values of the axis below.  means: at each x, with intervals.
    pooled: how many sets went into each mean; more than 1: it is the mean over the other axes.
    """

    value: Any
    x: tuple[Any, ...]
    means: tuple[Interval, ...]
    pooled: int


@dataclass(frozen=True, slots=True)
class Panel:
    """value: the panel's value of its axis."""

    value: Any
    curves: tuple[Curve, ...]


def panels(samples: Samples, x: str, line: str | None = None, panel: str | None = None) -> tuple[Panel, ...]:
    """x, line, panel: names of axes; other axes are averaged over, every set counting alike."""
    return tuple(
        Panel(value, _curves(part, x, line)) for value, part in split(samples, panel) if len(part.points)
    )


def split(samples: Samples, axis: str | None) -> list[tuple[Any, Samples]]:
    """The samples at each value of an axis; all of them for None."""
    if axis is None:
        return [(None, samples)]
    return [(value, samples.only({axis: value})) for value in samples.levels(axis)]


def _curves(samples: Samples, x: str, line: str | None) -> tuple[Curve, ...]:
    return tuple(_curve(value, part, x) for value, part in split(samples, line))


def _curve(value: Any, samples: Samples, x: str) -> Curve:
    points = split(samples, x)
    return Curve(
        value,
        tuple(level for level, _ in points),
        tuple(mean_of_means(part.groups()) for _, part in points),
        max(len(part.points) for _, part in points),
    )
