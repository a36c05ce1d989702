"""What section 6 of the paper prints in numbers: its table of variances and deviations."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from control.studies.definition import StudyDefinition
from server.reports.study.layout import STEP, SWEEP, TILT

SAME = 0.01
"""Variance and deviation^2 within this share of each other are consistent: the paper prints five digits."""
NAMES = {"geometric": "Gb", "gradient": "Ob"}
PATH_STEP_S = 0.1
UNIT_NOTE = (
    "The paper prints variances without a unit, of a “normalized error” that it does not define there; they are "
    "far larger than any variance of ME could be, so only their order and their ratios can be compared with ours."
)


@dataclass(frozen=True, slots=True)
class PrintedRow:
    """A row of the paper's table. label: Gb or Ob.  sweep, tilt: deg.  variance, deviation: as printed, no unit."""

    label: str
    sweep_deg: int
    tilt_deg: int
    variance: float
    deviation: float

    @property
    def consistent(self) -> bool:
        return abs(self.deviation**2 - self.variance) <= SAME * self.variance


PRINTED = (
    PrintedRow("Gb", 25, 25, 41.8677, 6.47053),
    PrintedRow("Ob", 25, 25, 47.9418, 6.47625),
    PrintedRow("Gb", 30, 25, 98.4696, 9.92318),
    PrintedRow("Ob", 30, 25, 99.291, 9.96449),
    PrintedRow("Gb", 30, 30, 14.0265, 3.46792),
    PrintedRow("Ob", 30, 30, 14.6243, 3.82418),
)


def printed_row(definition: StudyDefinition, values: Mapping[str, Any]) -> PrintedRow | None:
    """The paper's row for a set of a study; values: of its axes, lab units. The path has to be the eight."""
    if (
        value_of(definition, values, "trajectory") != "eight"
        or value_of(definition, values, STEP) != PATH_STEP_S
    ):
        return None
    label = NAMES.get(str(value_of(definition, values, "controller")))
    place = (label, value_of(definition, values, SWEEP), value_of(definition, values, TILT))
    return next((row for row in PRINTED if (row.label, row.sweep_deg, row.tilt_deg) == place), None)


def value_of(definition: StudyDefinition, values: Mapping[str, Any], axis: str) -> Any:
    """A set's value of an axis, or the definition's own where it is none; None for a parameter that it leaves open."""
    if values.get(axis) is not None:
        return values[axis]
    subject, _, field = axis.partition(".")
    section = definition.model_dump().get(subject, {})
    if not field:
        return section.get("name")
    return section.get(field, section.get("parameters", {}).get(field))
