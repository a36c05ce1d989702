"""The columns of the table: one row is one tick, and each column one value of that tick's messages, as recorded.

Unit and description are those of the recording's own schema, so table and recording cannot disagree.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

from server.recording.topics import EACH_TICK

Value = float | int | bool | str | None
Step = str | int
"""A field's name, or a place in an array."""


class Kind(StrEnum):
    """What a column holds, by the name that JSON schemas have for it."""

    NUMBER = "number"
    COUNT = "integer"
    FLAG = "boolean"
    WORD = "string"


@dataclass(frozen=True, slots=True)
class Column:
    """name: with its unit.  path: from the message of that topic to the value."""

    name: str
    topic: str
    path: tuple[Step, ...]
    kind: Kind
    unit: str
    description: str

    def of(self, tick: Mapping[str, Mapping[str, Any]]) -> Value:
        """The value of that tick; None where it is unknown, or not of the column's kind."""
        value: Any = tick.get(self.topic)
        for step in self.path:
            value = _inside(value, step)
        return _as(self.kind, value)


def _inside(value: Any, step: Step) -> Any:
    if isinstance(step, str):
        return value.get(step) if isinstance(value, dict) else None
    return value[step] if isinstance(value, list) and step < len(value) else None


def _as(kind: Kind, value: Any) -> Value:
    if kind is Kind.WORD:
        return value if isinstance(value, str) else None
    if kind is Kind.FLAG or isinstance(value, bool):
        return value if kind is Kind.FLAG and isinstance(value, bool) else None
    if isinstance(value, int) and not abs(value) <= LARGEST_COUNT:
        return None
    if kind is Kind.COUNT:
        return value if isinstance(value, int) else None
    return float(value) if isinstance(value, int | float) and math.isfinite(value) else None


LARGEST_COUNT = 2**53
"""The largest whole number up to which a double has all of them, as MAT files need."""

Place = tuple[str, str, str]
"""Name of the column, topic, and the path in it."""


def _axes(name: str, unit: str, topic: str, field: str) -> list[Place]:
    """A column for each of x, y and z."""
    return [(f"{name}_{axis}{unit}", topic, f"{field}.{index}") for index, axis in enumerate("xyz")]


_PLACES: tuple[Place, ...] = (
    ("time_s", "/state", "time_s"),
    ("tick", "/state", "tick"),
    ("run_s", "/state", "run.elapsed_s"),
    ("rig", "/state", "rig"),
    ("reason", "/state", "reason"),
    ("tracking", "/state", "tracking"),
    ("tracking_age_s", "/state", "tracking_age_s"),
    ("x_mm", "/estimate", "x_mm"),
    ("y_mm", "/estimate", "y_mm"),
    ("heading_deg", "/estimate", "heading_deg"),
    ("sigma_x_mm", "/estimate", "sigma_x_mm"),
    ("sigma_y_mm", "/estimate", "sigma_y_mm"),
    ("sigma_heading_deg", "/estimate", "sigma_heading_deg"),
    ("covariance_x_x_mm2", "/estimate", "covariance_mm_deg.0"),
    ("covariance_x_y_mm2", "/estimate", "covariance_mm_deg.1"),
    ("covariance_x_heading_mm_deg", "/estimate", "covariance_mm_deg.2"),
    ("covariance_y_y_mm2", "/estimate", "covariance_mm_deg.4"),
    ("covariance_y_heading_mm_deg", "/estimate", "covariance_mm_deg.5"),
    ("covariance_heading_heading_deg2", "/estimate", "covariance_mm_deg.8"),
    ("captured_s", "/measurement", "captured_s"),
    ("x_measured_mm", "/measurement", "x_mm"),
    ("y_measured_mm", "/measurement", "y_mm"),
    ("heading_measured_deg", "/measurement", "heading_deg"),
    ("u_measured_px", "/measurement", "centre_px.0"),
    ("v_measured_px", "/measurement", "centre_px.1"),
    ("area_measured_px2", "/measurement", "area_px"),
    ("x_reference_mm", "/reference", "x_mm"),
    ("y_reference_mm", "/reference", "y_mm"),
    ("error_mm", "/reference", "error_mm"),
    ("controller", "/command", "controller"),
    ("pivot", "/command", "pivot"),
    ("rate_deg_s", "/command", "rate_deg_s"),
    ("heading_goal_deg", "/command", "heading_goal_deg"),
    ("tilt_deg", "/command", "tilt_deg"),
    ("field_command_mT", "/command", "field_mT"),
    *_axes("current", "_A", "/currents", "commanded_A"),
    *_axes("measured", "_A", "/currents", "measured_A"),
    *_axes("field", "_mT", "/field", "field_mT"),
    ("field_heading_deg", "/field", "heading_deg"),
    ("field_elevation_deg", "/field", "elevation_deg"),
    ("field_strength_mT", "/field", "strength_mT"),
    ("body_tilt_deg", "/state", "body_tilt_deg"),
    ("limited_by", "/state", "limited_by"),
    *_axes("coil_heat", "", "/state", "coil_heat"),
    ("passes_done", "/state", "run.passes_done"),
    ("mean_error_mm", "/state", "run.mean_error_mm"),
    ("steps", "/state", "run.steps"),
    ("sweeps", "/state", "run.sweeps"),
    ("reversals", "/state", "run.reversals"),
    ("loop_rate_Hz", "/timing", "rate_Hz"),
    ("loop_period_p99_ms", "/timing", "period_p99_ms"),
    ("latency_p50_ms", "/timing", "latency_p50_ms"),
    ("latency_p99_ms", "/timing", "latency_p99_ms"),
    ("dropped_frames", "/timing", "dropped_frames"),
    ("camera_latency_ms", "/timing", "camera_latency_ms"),
    ("camera_rate_Hz", "/timing", "camera_rate_Hz"),
)

_MIXED_UNITS = {"_mm2": "mm^2", "_mm_deg": "mm deg", "_deg2": "deg^2"}
"""Of the covariance, whose array has no unit of its own: by the end of the column's name."""


def _column(place: Place, schemas: Mapping[str, Any]) -> Column:
    name, topic, written = place
    path = tuple(int(step) if step.isdigit() else step for step in written.split("."))
    schema, described = schemas[topic], {}
    for step in path:
        schema = schema["items"] if isinstance(step, int) else schema["properties"][step]
        described |= {key: schema[key] for key in ("unit", "description") if key in schema}
    unit = next((unit for end, unit in _MIXED_UNITS.items() if name.endswith(end)), described["unit"])
    return Column(name, topic, path, Kind(schema["type"]), unit, f"{topic}: {described['description']}")


def _columns() -> tuple[Column, ...]:
    schemas = {topic.name: topic.schema for topic in EACH_TICK}
    return tuple(_column(place, schemas) for place in _PLACES)


COLUMNS = _columns()


def named(names: Iterable[str]) -> tuple[Column, ...]:
    """Those columns, in that order."""
    known = {column.name: column for column in COLUMNS}
    return tuple(known[name] for name in names)
