"""How axes, their values and metrics are called in a report: words and units."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from control.studies.analysis.intervals import Interval
from control.studies.analysis.samples import is_number
from control.studies.table import METRICS

UNITS = {"deg": "°", "percent": "%", "ohm": "Ω", "uT": "µT"}
"""Written otherwise than in a name; every other unit in a name is written as it is."""
KNOWN_UNITS = frozenset(
    {
        "deg",
        "percent",
        "ohm",
        "uT",
        "mm",
        "s",
        "ms",
        "mT",
        "Hz",
        "rad",
        "A",
        "W",
        "V",
        "mg",
        "mN",
        "mm_s",
        "mm_s2",
    }
)
DIGITS = 3
"""Of a metric."""


def axis_name(axis: str) -> str:
    """`gait.tilt_deg` -> tilt; `controller.gain` -> controller gain; `plant` -> plant."""
    subject, _, field = axis.partition(".")
    words = _without_unit(field or subject).replace("_", " ")
    return words if subject == "gait" or not field else f"{subject} {words}"


def axis_unit(axis: str) -> str:
    """As written behind a number; empty where the name tells none."""
    field = axis.partition(".")[2]
    unit = field[len(_without_unit(field)) :].lstrip("_")
    return UNITS.get(unit, unit.replace("mm_s2", "mm/s²").replace("mm_s", "mm/s"))


def axis_title(axis: str) -> str:
    unit = axis_unit(axis)
    return f"{axis_name(axis)}, {unit}" if unit else axis_name(axis)


def _without_unit(field: str) -> str:
    words = field.split("_")
    for count in (2, 1):
        if len(words) > count and "_".join(words[-count:]) in KNOWN_UNITS:
            return "_".join(words[:-count])
    return field


def value_text(axis: str, value: Any) -> str:
    """With its unit: 25°, 0.1 s, geometric."""
    if value is None:
        return "as defined"
    if not is_number(value):
        return str(value)
    unit = axis_unit(axis)
    gap = "" if unit in ("°", "") else " "
    return f"{value:.6g}{gap}{unit}"


def point_text(values: Mapping[str, Any]) -> str:
    """tilt 25°, path step 0.1 s."""
    return ", ".join(f"{axis_name(axis)} {value_text(axis, value)}" for axis, value in values.items())


def metric_title(metric: str) -> str:
    title, unit = METRICS.get(metric, (metric, "1"))
    return title if unit == "1" else f"{title}, {unit}"


def short_metric(metric: str) -> str:
    return "ME" if metric == "normalized_mean_error" else METRICS.get(metric, (metric,))[0].lower()


def number(value: float, digits: int = DIGITS) -> str:
    return f"{value:.{digits}g}" if math.isfinite(value) else "–"


def with_interval(interval: Interval, unit: str = "") -> str:
    """0.213 (0.208 to 0.219); the number alone where there is no interval."""
    gap = "" if unit in ("", "°") else " "
    if not interval.known:
        return f"{number(interval.value)}{gap}{unit}"
    digits = _digits(interval)
    low, value, high = (f"{one:.{digits}f}" for one in (interval.low, interval.value, interval.high))
    return f"{value}{gap}{unit} ({low} to {high})"


def _digits(interval: Interval) -> int:
    """Decimals: two digits of the half width."""
    width = interval.half_width
    if not width > 0.0:
        return DIGITS
    return min(max(1 - math.floor(math.log10(width)), 0), 9)


def chance_text(p: float) -> str:
    if not math.isfinite(p):
        return "–"
    return "<\u00a00.0001" if p < 1e-4 else f"{p:.2g}"
