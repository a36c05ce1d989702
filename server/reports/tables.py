"""The report's numbers as CSV: one row each, lab units in the names."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence

from server.reports.findings import PAPER_STEPS, Finding
from server.reports.locomotion import Locomotion
from server.reports.simulation import Result, Simulation

MM = 1e-3
Cell = str | int | float
Table = Sequence[Sequence[Cell]]
"""The first row names the columns."""


def csv_text(table: Table) -> str:
    stream = io.StringIO()
    csv.writer(stream, lineterminator="\n").writerows(table)
    return stream.getvalue()


def findings(found: Sequence[Finding]) -> Table:
    rows = [(one.section, one.paper, one.ours, one.verdict.value, one.note) for one in found]
    return [("section", "paper", "ours", "verdict", "note"), *rows]


def paths(found: Locomotion) -> Table:
    header = ("sweep_deg", "centre_x_mm", "centre_y_mm", "a_x_mm", "a_y_mm", "b_x_mm", "b_y_mm")
    rows = [
        (round(path.sweep_deg, 6), *(round(float(value) / MM, 5) for value in (*centre, *a, *b)))
        for path in found.paths
        for centre, a, b in zip(path.centre, path.a, path.b, strict=True)
    ]
    return [header, *rows]


def costs(found: Locomotion) -> Table:
    header = ("sweep_deg", "steps_closed_form", "steps_walked", "travel_closed_form_mm", "travel_walked_mm")
    rows = [
        (cost.sweep_deg, cost.steps, cost.counted, round(cost.travel / MM, 5), round(cost.travelled / MM, 5))
        for cost in found.costs
    ]
    return [header, *rows]


def cases(results: Sequence[Result]) -> Table:
    header = (
        "sweep_deg", "controller", "parameters", "steps_paper", "steps", "sweeps", "reversals", "mean_error_mm",
        "rms_error_mm", "max_error_mm", "travelled_mm",
    )  # fmt: skip
    return [header, *(_case(result) for result in results)]


def _case(result: Result) -> tuple[Cell, ...]:
    case, metrics = result.case, result.metrics
    lengths = (metrics.mean_error, metrics.rms_error, metrics.max_error, metrics.travelled)
    return (
        case.sweep_deg,
        case.label,
        " ".join(f"{name}={value}" for name, value in case.parameters.items()),
        PAPER_STEPS.get((case.label, case.sweep_deg), ""),
        metrics.steps,
        metrics.sweeps,
        metrics.reversals,
        *(round(length / MM, 4) for length in lengths),
    )


def error_curves(found: Simulation) -> Table:
    """One row a tick, one column a case."""
    header = ("time_s", *(f"{r.case.label}, sweep {r.case.sweep_deg}, mm" for r in found.cases))
    columns = [result.error / MM for result in found.cases]
    rows = [
        (round(0.1 * tick, 1), *(round(float(value), 4) for value in values))
        for tick, values in enumerate(zip(*columns, strict=True))
    ]
    return [header, *rows]
