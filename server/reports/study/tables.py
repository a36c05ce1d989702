"""A study's results as tables, for the page and as CSV; lab units in the names of the columns."""

from __future__ import annotations

import math

from control.studies.analysis.comparison import Comparison
from control.studies.analysis.distribution import Distribution
from control.studies.analysis.intervals import Interval
from control.studies.analysis.optimum import Kind, Optimum
from control.studies.analysis.whole import Analysis
from control.studies.definition import StudyDefinition
from server.reports.study.naming import axis_name, chance_text, number, point_text, short_metric, value_text
from server.reports.study.printed import printed_row
from server.reports.tables import Cell, Table

DIGITS = 6
"""Significant digits of a result in a table: more than any of them is worth, so that nothing is lost."""


def all_of(found: Analysis, definition: StudyDefinition) -> dict[str, Table]:
    """By name; those without rows have their header only."""
    return {
        "sets": sets(found),
        "optima": optima((*found.overall, *found.apart)),
        "effects": effects(found),
        "comparisons": comparisons(found.comparisons),
        "scatters": scatters(found, definition),
        "weibulls": weibulls(found),
    }


def sets(found: Analysis) -> Table:
    metric = short_metric(found.samples.metric)
    header = (
        "set", *(axis.replace(".", " ") for axis in found.samples.axes), "runs", "failed", metric, "low", "high",
        "deviation", "variance",
    )  # fmt: skip
    rows = [
        (
            one.number, *(_value(one.values[axis]) for axis in found.samples.axes), one.runs, one.failed,
            *_interval(one.mean), _rounded(one.deviation), _rounded(one.variance),
        )
        for one in found.summaries
    ]  # fmt: skip
    return [header, *rows]


def optima(found: tuple[Optimum, ...]) -> Table:
    header = (
        "along",
        "at",
        "smallest at",
        "low",
        "high",
        "value",
        "value low",
        "value high",
        "the optimum is",
        "best level",
    )
    return [header, *(_optimum(one) for one in found)]


def _optimum(one: Optimum) -> tuple[Cell, ...]:
    where = ("", "", "") if one.kind is Kind.UNKNOWN else _interval(one.where)
    return (
        axis_name(one.axis), point_text(one.fixed) or "mean over the others", *where, *_interval(one.value),
        one.kind.value, value_text(one.axis, one.measured),
    )  # fmt: skip


def effects(found: Analysis) -> Table:
    if found.effects is None:
        header = ("axis", "share of variance", "p", "rank correlation", "p of it", "sets")
        return [
            header,
            *(
                (
                    axis_name(one.axis), _rounded(one.share), chance_text(one.p), _rounded(one.rank_correlation),
                    chance_text(one.p_monotone), one.points,
                )
                for one in found.influences
            ),
        ]  # fmt: skip
    rows = [
        (
            " × ".join(axis_name(axis) for axis in one.axes), *_interval(one.share), _rounded(one.swing),
            one.freedom, chance_text(one.p),
        )
        for one in found.effects.effects
    ]  # fmt: skip
    rest = ("the rest (runs of the same set)", _rounded(found.effects.noise), "", "", "", "", "")
    return [("axis", "share of variance", "low", "high", "swing", "freedom", "p"), *rows, rest]


def comparisons(found: tuple[Comparison, ...]) -> Table:
    header = (
        "at", "one", "other", "mean of one", "mean of other", "difference", "low", "high", "one is", "p (Welch)",
        "p (ranks)", "effect g", "one below other in", "runs",
    )  # fmt: skip
    rows = [
        (
            point_text(one.fixed), value_text(one.axis, one.one), value_text(one.axis, one.other),
            *map(_rounded, one.means),
            *_interval(one.difference), one.order.value, chance_text(one.p_welch), chance_text(one.p_ranks),
            _rounded(one.effect), f"{100.0 * one.below:.0f} %", f"{one.runs[0]} and {one.runs[1]}",
        )
        for one in found
    ]  # fmt: skip
    return [header, *rows]


def scatters(found: Analysis, definition: StudyDefinition) -> Table:
    """Variance and deviation of each set, the paper's beside ours where it is one of the paper's sets."""
    header = (
        "set", "runs", "mean", "variance", "deviation", "low", "high", "skewness", "paper's variance",
        "paper's deviation", "of the paper's row",
    )  # fmt: skip
    rows = []
    for place, one in found.distributions.items():
        values = dict(zip(found.samples.axes, found.samples.points[place], strict=True))
        paper = printed_row(definition, values)
        note = ("", "", "")
        if paper is not None:
            fits = (
                "consistent" if paper.consistent else f"inconsistent: deviation² is {paper.deviation**2:.2f}"
            )
            note = (paper.variance, paper.deviation, fits)
        rows.append((
            point_text(values) or "all runs", len(one.values), _rounded(one.mean.value), _rounded(one.variance.value),
            *_interval(one.deviation), _rounded(one.skewness), *note,
        ))  # fmt: skip
    return [header, *rows]


def weibulls(found: Analysis) -> Table:
    header = (
        "set", "runs", "shape", "low", "high", "scale", "low", "high", "p (Anderson)", "p (Kolmogorov)",
        "location", "shape then", "p then", "fits best", "worse by",
    )  # fmt: skip
    return [
        header,
        *(
            (_named(found, place), *_weibull(one))
            for place, one in found.distributions.items()
            if one.weibull is not None
        ),
    ]


def _named(found: Analysis, place: int) -> str:
    return point_text(dict(zip(found.samples.axes, found.samples.points[place], strict=True))) or "all runs"


def _weibull(one: Distribution) -> tuple[Cell, ...]:
    if one.weibull is None or one.located is None:
        return ()
    located = one.located
    return (
        one.weibull.runs, *_interval(one.weibull.shape), *_interval(one.weibull.scale),
        chance_text(one.weibull.p_anderson), chance_text(one.weibull.p_kolmogorov),
        "far below" if located.far else _rounded(located.law.location),
        "–" if located.far else _rounded(located.law.shape), chance_text(located.p_anderson),
        *preferred(one),
    )  # fmt: skip


def preferred(one: Distribution) -> tuple[str, str]:
    """The law that fits best, and by how much of Akaike's criterion each other one is worse."""
    ordered = sorted(one.preference.items(), key=lambda item: item[1])
    return ordered[0][0], ", ".join(f"{name} {number(worse, 2)}" for name, worse in ordered[1:])


def _interval(interval: Interval) -> tuple[Cell, Cell, Cell]:
    return _rounded(interval.value), _rounded(interval.low), _rounded(interval.high)


def _rounded(value: float) -> Cell:
    """A figure that there is none of is an empty cell."""
    return float(f"{value:.{DIGITS}g}") if math.isfinite(value) else ""


def _value(value: object) -> Cell:
    return value if isinstance(value, str | int | float) else "" if value is None else str(value)
