"""Section 6 as a part of the report."""

from __future__ import annotations

import math
from collections.abc import Sequence

from control.simulation.rigid.tilt_study import TiltPoint, tilt_study
from control.studies.analysis.intervals import Interval
from server.reports import page
from server.reports.experiments import pictures, tilt_claims
from server.reports.experiments.carrying import Tables, file_of
from server.reports.experiments.claims import findings, scatter
from server.reports.experiments.designs import MISSING, RIGID, Experiment
from server.reports.experiments.scatter_claims import LABELS, Scatter
from server.reports.page import Picture
from server.reports.part import Part
from server.reports.rigid_tilt import NOTES, tilt_table
from server.reports.study.printed import PRINTED
from server.reports.tables import Cell, Table

RATIOS = (2.0, 2.6, 7.0)
"""Λ of the robots whose pivot switches are looked at: hardly lifting, the plant's default, strong."""
DEFAULT_RATIO = 2.6
TILTS = tuple(math.radians(tilt) for tilt in range(10, 40, 5))
RAMPS = (0.050, 0.150)

UNKNOWNS = (
    "Section 6 prints curves without numbers, no gains, and neither where its runs start nor how long they last. "
    "Each of our runs is one eight at its path step, starts at the eight's first point, heading along it, with the "
    "default gains.",
    "Section 6 is measured on a robot whose magnet, weight and friction are not printed. Ours walks on plants that are "
    "assumed: none was changed to come nearer to the paper. The runs are without camera and estimate (the "
    "controllers see the robot's true pose) and without serial line and coils (the field is the commanded one).",
    "The paper's “normalized error” of its table is hundreds of times its ME; how it is made is not printed.",
)


def part(studies: Sequence[Experiment], tables: Tables) -> Part:
    """tables: of these studies, by their keys."""
    laws = scatter(tables)
    points = list(tilt_study(RATIOS, RAMPS, TILTS)) if RIGID in tables else []
    found = findings(tables, laws)
    if points:
        quick = [point for point in points if point.ramp == RAMPS[0]]
        found.append(tilt_claims.cause([point for point in quick if point.ratio == DEFAULT_RATIO]))
        found.append(tilt_claims.by_magnet(quick))
    shown = _pictures(studies, tables, laws, points)
    numbers = {"section6_scatter": widths(laws)}
    if points:
        numbers["section6_rigid_switches"] = tilt_table(points)
    return Part(
        findings=tuple(found),
        pictures=tuple(shown),
        tables=numbers,
        body=tuple(_body(studies, tables, shown, numbers["section6_scatter"])),
        unknowns=UNKNOWNS,
        raw={file_of(key): table.csv() for key, table in tables.items()},
    )


def _pictures(
    studies: Sequence[Experiment], tables: Tables, laws: Scatter, points: Sequence[TiltPoint]
) -> list[Picture]:
    by_key = {study.key: study for study in studies}
    return [
        *pictures.of_studies(tables),
        *pictures.of_rigid(tables, points),
        pictures.of_scatter(laws),
        *pictures.of_paths(by_key, tables),
    ]


def _body(
    studies: Sequence[Experiment], tables: Tables, shown: Sequence[Picture], scattered: Table
) -> list[str]:
    return [
        page.heading("Section 6: experiments"),
        page.paragraph("Batches of runs on simulated robots, without pixels and bytes. What was run:"),
        page.listing(extent(studies, tables)),
        *(page.picture(one) for one in shown),
        page.table(scattered),
        *([page.listing(NOTES)] if RIGID in tables else []),
    ]


def extent(studies: Sequence[Experiment], tables: Tables) -> list[str]:
    """How much was run, what failed, and what did not take part; fewer runs than the paper's are said to be."""
    lines = []
    for study in studies:
        failed = [row.reason for row in tables[study.key].rows if row.state == "failed"]
        lost = f"; {len(failed)} failed, the first one because {failed[0]}" if failed else ""
        lines.append(f"{study.scale}{lost}.")
    if any(study.reduced for study in studies):
        lines.append("These are fewer runs than the paper's: the intervals are wider, and less can be told.")
    if RIGID not in tables:
        lines.append(f"{MISSING}, or was left out.")
    return lines


def widths(found: Scatter) -> Table:
    """Variance and deviation of ME for each set and controller, beside the paper's, whose rows may be inconsistent."""
    header = (
        "controller", "sweep_deg", "tilt_deg", "runs", "ME", "ME_low", "ME_high", "variance", "deviation", "shape",
        "shape_low", "shape_high", "scale", "scale_low", "scale_high", "p_Weibull", "paper_variance",
        "paper_deviation", "paper_row",
    )  # fmt: skip
    return [header, *(_width(found, key) for key in found.laws)]


def _width(found: Scatter, key: tuple[str, int, int]) -> tuple[Cell, ...]:
    controller, sweep, tilt = key
    law, label = found.laws[key], LABELS[controller]
    printed = next((r for r in PRINTED if (r.label, r.sweep_deg, r.tilt_deg) == (label, sweep, tilt)), None)
    fit = law.weibull
    paper: tuple[Cell, ...] = ("", "", "–")
    if printed is not None:
        paper = (printed.variance, printed.deviation, "consistent" if printed.consistent else "inconsistent")
    return (
        label, sweep, tilt, len(law.values),
        *(_number(value) for value in (law.mean.value, law.mean.low, law.mean.high)),
        _number(law.variance.value), _number(law.deviation.value),
        *_interval(None if fit is None else fit.shape), *_interval(None if fit is None else fit.scale),
        "" if fit is None else _number(fit.p_anderson),
        *paper,
    )  # fmt: skip


def _interval(one: Interval | None) -> tuple[Cell, Cell, Cell]:
    return ("", "", "") if one is None else (_number(one.value), _number(one.low), _number(one.high))


def _number(value: float) -> Cell:
    return float(f"{value:.4g}") if math.isfinite(value) else ""
