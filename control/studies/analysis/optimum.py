"""Where along one axis a metric is smallest, and how surely that is known."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from control.studies.analysis.intervals import LEVEL, Interval, moments
from control.studies.analysis.samples import Samples
from control.studies.analysis.spline import smoother

Array = NDArray[np.float64]
FEWEST_LEVELS = 3
"""A smallest value between two ends needs three levels."""
DRAWS = 2000
FLAT = 0.7
"""An interval of the place that covers more than this share of the range says nothing about it. A choice."""
EDGE = 0.02
"""Within this share of the range of an end, the smallest value counts as being at that end."""
SEED = 245


class Kind(StrEnum):
    INSIDE = "inside"
    LOWER_EDGE = "at the lower edge"
    UPPER_EDGE = "at the upper edge"
    FLAT = "flat"
    UNKNOWN = "unknown"


@dataclass(frozen=True, slots=True)
class Optimum:
    """axis: searched.  fixed: values of the other axes; empty: averaged over them.  where: lab units.
    value: the metric there.  kind: FLAT: the data do not tell where; UNKNOWN: not enough levels or repeats.
    measured: the level with the smallest mean.  line_x, line: the smooth line, for a figure.
    """

    axis: str
    fixed: Mapping[str, Any]
    where: Interval
    value: Interval
    kind: Kind
    measured: float
    line_x: Array
    line: Array

    @property
    def open_ended(self) -> bool:
        """Whether the interval of the place reaches an end of what was tried."""
        margin = EDGE * float(self.line_x[-1] - self.line_x[0])
        return self.where.low <= self.line_x[0] + margin or self.where.high >= self.line_x[-1] - margin


def optimum(samples: Samples, axis: str, fixed: Mapping[str, Any] | None = None) -> Optimum | None:
    """fixed: values of other axes; what is left of them is averaged over, every set counting alike.

    The means at the axis' levels are joined by a smooth line; the interval comes from lines through means drawn from
    their Student distributions. None where the axis is not numeric or nothing was measured.
    """
    if not samples.numeric(axis):
        return None
    part = samples.only(fixed or {})
    x, means, errors, freedoms = _levels(part, axis)
    if not len(x):
        return None
    return _found(_Levels(axis, fixed or {}, x, means, errors, freedoms))


@dataclass(frozen=True, slots=True)
class _Levels:
    axis: str
    fixed: Mapping[str, Any]
    x: Array
    means: Array
    errors: Array
    freedoms: Array


def _levels(samples: Samples, axis: str) -> tuple[Array, Array, Array, Array]:
    """Level, mean, standard error (NaN: unknown) and its degrees of freedom, for each level with finished runs.

    Only the other axes' points that were measured at every level take part: a missing set would shift a mean. Where
    there is no such point, all take part.
    """
    measured: dict[Any, dict[Any, Array]] = {}
    for point, level, group in zip(_rest(samples, axis), samples.column(axis), samples.groups(), strict=True):
        if len(group):
            measured.setdefault(level, {})[point] = group
    everywhere = set[Any].intersection(*(set(found) for found in measured.values())) if measured else set()
    rows = [
        (
            float(level),
            *moments([found[point] for point in sorted(everywhere & set(found) or found, key=str)]),
        )
        for level, found in sorted(measured.items())
    ]
    return tuple(np.array(rows, dtype=float).reshape(-1, 4).T)  # pyright: ignore[reportReturnType]


def _rest(samples: Samples, axis: str) -> list[tuple[Any, ...]]:
    """Each set's values of the other axes."""
    at = samples.axes.index(axis)
    return [point[:at] + point[at + 1 :] for point in samples.points]


def _found(levels: _Levels) -> Optimum:
    smallest = int(np.argmin(levels.means))
    measured = float(levels.x[smallest])
    if len(levels.x) < FEWEST_LEVELS:
        return Optimum(
            levels.axis, levels.fixed, Interval(measured), Interval(float(levels.means[smallest])), Kind.UNKNOWN,
            measured, levels.x, levels.means,
        )  # fmt: skip
    through = smoother(levels.x, levels.means, levels.errors)
    line = through.line(levels.means)
    at = int(np.argmin(line))
    where, value = _intervals(levels, through.x, line, through.operator)
    return Optimum(
        levels.axis,
        levels.fixed,
        where,
        value,
        _kind(through.x, at, where),
        measured,
        through.x,
        line,
    )


def _intervals(levels: _Levels, x: Array, line: Array, operator: Array) -> tuple[Interval, Interval]:
    at = int(np.argmin(line))
    where, value = float(x[at]), float(line[at])
    if not np.all(np.isfinite(levels.errors)):
        return Interval(where), Interval(value)
    rng = np.random.default_rng(SEED)
    drawn = levels.means + levels.errors * rng.standard_t(levels.freedoms, size=(DRAWS, len(levels.x)))
    lines = drawn @ operator.T
    places = np.argmin(lines, axis=1)
    return (
        Interval(where, *_between(x[places], where)),
        Interval(value, *_between(lines[:, at], value)),
    )


def _between(draws: Array, value: float) -> tuple[float, float]:
    low, high = np.quantile(draws, (0.5 - 0.5 * LEVEL, 0.5 + 0.5 * LEVEL))
    return min(float(low), value), max(float(high), value)


def _kind(x: Array, at: int, where: Interval) -> Kind:
    span = float(x[-1] - x[0])
    if not where.known:
        return Kind.UNKNOWN
    if where.high - where.low > FLAT * span:
        return Kind.FLAT
    if x[at] - x[0] <= EDGE * span:
        return Kind.LOWER_EDGE
    if x[-1] - x[at] <= EDGE * span:
        return Kind.UPPER_EDGE
    return Kind.INSIDE
