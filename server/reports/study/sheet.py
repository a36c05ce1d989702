"""The page of a study's report, put together."""

from __future__ import annotations

import platform
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from importlib.metadata import version

from control.studies.analysis.whole import Analysis
from control.studies.definition import StudyDefinition
from control.studies.table import StudyTable
from server.api.state import VERSION
from server.reports import page
from server.reports.page import Picture
from server.reports.study import words
from server.reports.study.naming import axis_name, metric_title, short_metric
from server.reports.study.printed import UNIT_NOTE
from server.reports.tables import Cell, Table

MOST_ROWS = 100
"""Rows of a table on the page; its CSV has all."""
DIGITS = 4
"""Significant digits on the page; the CSV has more."""
LIBRARIES = ("numpy", "scipy", "numba")
METHODS = (
    "Means have Student's 95 % intervals, and a difference of two means has Welch's. A set with one run has none.",
    "The optimum along an axis: a natural smoothing spline through the levels' means (Mallows' Cp from the scatter of "
    "the repeats; below five levels the polynomial through them), and 2000 lines through means drawn anew for the "
    "intervals. “Flat” means that the interval covers more than 70 % of the range.",
    "Shares of variance: analysis of variance with the interactions of two axes, type II sums of squares, intervals by "
    "the noncentral F distribution; intervals and p suppose that all sets scatter alike. Of scattered points: Kruskal "
    "and Wallis over fifths of each axis, and Spearman's rank correlation.",
    "Weibull laws: maximum likelihood; intervals and the p of both tests are exact but for their Monte Carlo with up "
    "to 4000 samples of the same size. With a location: profile likelihood with a shape of at least 1, p from 199 "
    "parametric bootstraps. Laws are compared by Akaike's criterion, corrected for few runs. Deviations have Bonett's "
    "intervals, which hold the true one in about 92 to 95 of 100 cases.",
    "The smooth surface through scattered sets is a Gaussian process over the logarithm of the sets' means, as for an "
    "auto-tune; its intervals are those of the smallest places of 500 surfaces drawn from it.",
    "Many tests are made in one report, so about one in twenty p below 0.05 is there by chance.",
)
ASSUMED = (
    "These runs are simulated: where an optimum lies and how runs scatter are properties of the assumed robot and "
    "plate, and say of yours only as much as those resemble it."
)


@dataclass(frozen=True, slots=True)
class Content:
    """pictures: measured, distributed, walked.  tables: by name, those that have rows."""

    definition: StudyDefinition
    table: StudyTable
    found: Analysis
    pictures: Mapping[str, Sequence[Picture]]
    tables: Mapping[str, Table]


def sheet(content: Content) -> str:
    """HTML that stands alone."""
    return page.page(content.definition.name, list(_body(content)))


def _body(content: Content) -> Iterator[str]:
    definition, found = content.definition, content.found
    yield f"<h1>{escape(definition.name)}</h1>"
    yield page.paragraph(asked(definition, found))
    yield page.heading("What was found")
    before = words.unfinished(content.table, definition)
    yield page.listing([*before, *_searched(content), *words.sentences(found, content.table)])
    if definition.on == "batch":
        yield page.paragraph(ASSUMED)
    yield page.heading(f"{metric_title(found.samples.metric)} over the axes")
    yield from map(page.picture, content.pictures["measured"])
    yield from _section(content, "Where it is smallest", "optima")
    yield from _section(content, "Which axis matters how much", "effects")
    yield from _section(content, "Which lies below which", "comparisons")
    if "scatters" in content.tables:
        yield from _distributions(content)
    if content.pictures["walked"]:
        yield page.heading("Paths")
        yield from map(page.picture, content.pictures["walked"])
    yield from _section(content, "All sets", "sets")
    yield page.heading("How it was computed")
    yield page.listing(METHODS)
    yield _origin(definition)


def _searched(content: Content) -> list[str]:
    """The answer of an auto-tune."""
    if content.definition.design != "tune":
        return []
    from control.studies.tuning import answer

    found = answer(content.definition, {row.index: row for row in content.table.rows})
    return [] if found is None else [words.of_search(found)]


def asked(definition: StudyDefinition, found: Analysis) -> str:
    """What was to be carried out."""
    where = (
        f"a batch on the plant {definition.plant.name}" if definition.on == "batch" else "a campaign on a rig"
    )
    axes = ", ".join(axis_name(axis) for axis in found.samples.axes) or "nothing"
    return (
        f"{where[0].upper()}{where[1:]}: {definition.design} over {axes}; repeats {definition.repeats}, order "
        f"{definition.order}, seed {definition.seed}. {short_metric(found.samples.metric)} is the mean distance of "
        "the robot's centre from the reference, divided by the robot's length."
    )


def _section(content: Content, title: str, name: str) -> Iterator[str]:
    if name in content.tables:
        yield page.heading(title)
        yield from _table(content.tables[name], name)


def _distributions(content: Content) -> Iterator[str]:
    yield page.heading("How single runs scatter")
    yield from map(page.picture, content.pictures["distributed"])
    scatters = content.tables["scatters"]
    yield from _table(scatters, "scatters")
    if any(row[-1] for row in scatters[1:]):
        yield page.paragraph(UNIT_NOTE)
    if "weibulls" in content.tables:
        yield from _table(content.tables["weibulls"], "weibulls")


def _table(table: Table, name: str) -> Iterator[str]:
    header, *rows = table
    yield page.table([header, *(tuple(map(_shown, row)) for row in rows[:MOST_ROWS])])
    if len(rows) > MOST_ROWS:
        yield page.paragraph(
            f"The first {MOST_ROWS} of {len(rows)} rows; {name}.csv beside this page has all."
        )


def _shown(cell: Cell) -> Cell:
    return float(f"{cell:.{DIGITS}g}") if isinstance(cell, float) else cell


def _origin(definition: StudyDefinition) -> str:
    """Definition and versions, so that the study can be made again."""
    libraries = ", ".join(f"{name} {version(name)}" for name in LIBRARIES)
    return (
        f"<details><summary>Definition</summary><pre>{escape(definition.to_toml())}</pre></details>"
        f"<p><small>pivotrig {VERSION}, Python {platform.python_version()}, {libraries}. Each run's seed is in "
        "runs.csv, all numbers behind the figures are in the CSV files beside this page, and study.toml is the "
        "definition, with which the same study can be carried out again.</small></p>"
    )
