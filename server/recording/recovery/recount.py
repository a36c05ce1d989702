"""The figures of a run, counted again from its recorded ticks where it did not live to write them itself."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

from control.axes import AXES
from control.gait import Counts
from control.metrics import Metrics, MetricsTally
from control.model import Pose
from server.recording.reading.tick_reading import Tick
from server.recording.writing.overview import Overview, Series

MM = 1e-3
PLACE = ("x_mm", "y_mm", "heading_deg")
NOTHING: Mapping[str, Any] = {}


class Recount:
    """ticks: of the recording, those after the run's end included."""

    def __init__(self, length: float) -> None:
        """length: between the pivots, m."""
        self.overview = Overview()
        self.ticks = 0
        self._tally = MetricsTally(length)
        self._run: Mapping[str, Any] = NOTHING

    def add(self, time: float, tick: Tick) -> None:
        """The messages of the next tick by topic; what they lack is left out.  time: since the run's start, s."""
        self.ticks += 1
        self.overview.add(time, lambda: point_of_messages(tick))
        run = tick.get("/state", NOTHING).get("run")
        if isinstance(run, dict):
            self._add_to_run(run, tick)

    def _add_to_run(self, run: Mapping[str, Any], tick: Tick) -> None:
        """The mean error of a run changes with each tick that counts: not while it is held or approaches its path."""
        before = number(self._run, "mean_error_mm") or 0.0
        self._run = run
        if number(run, "mean_error_mm") == before:
            return
        error, pose = (
            number(tick.get("/reference", NOTHING), "error_mm"),
            pose_of(tick.get("/estimate", NOTHING)),
        )
        if error is not None and pose is not None:
            self._tally.add(pose, error * MM)

    def metrics(self) -> Metrics | None:
        """None for a recording in which no run was seen to walk."""
        if self._run is NOTHING:
            return None
        steps, sweeps, reversals = (count(self._run, name) for name in ("steps", "sweeps", "reversals"))
        counts = Counts(steps=steps, sweeps=sweeps, reversals=reversals)
        return self._tally.metrics(counts, number(self._run, "elapsed_s") or 0.0)


def point_of_messages(tick: Tick) -> Series:
    """As `overview.point_of` makes it of a snapshot."""
    currents, command = tick.get("/currents", NOTHING), tick.get("/command", NOTHING)
    goal = number(command, "heading_goal_deg") if number(command, "field_mT") else None
    return {
        "error_mm": number(tick.get("/reference", NOTHING), "error_mm"),
        **_some(tick.get("/estimate"), PLACE),
        **_some(tick.get("/measurement"), PLACE, "_measured"),
        "heading_goal_deg": goal,
        **_some(tick.get("/reference"), PLACE[:2], "_reference"),
        **_axes("current", currents.get("commanded_A")),
        **_axes("measured", currents.get("measured_A")),
    }


def _some(message: Mapping[str, Any] | None, names: Iterable[str], suffix: str = "") -> Series:
    """Those numbers, with the suffix before their unit: x_mm becomes x_measured_mm."""
    found = message or NOTHING
    return {f"{what}{suffix}_{unit}": number(found, f"{what}_{unit}") for what, unit in map(_parts, names)}


def _parts(name: str) -> tuple[str, str]:
    what, _, unit = name.rpartition("_")
    return what, unit


def _axes(what: str, values: Any) -> Series:
    """A triple of currents, A, by axis."""
    known = values if isinstance(values, list) and len(values) == len(AXES) else (None,) * len(AXES)
    named = {f"{what}_{axis}_A": value for axis, value in zip(AXES, known, strict=True)}
    return {name: number(named, name) for name in named}


def pose_of(estimate: Mapping[str, Any]) -> Pose | None:
    x, y, heading = (number(estimate, name) for name in PLACE)
    if x is None or y is None or heading is None:
        return None
    return Pose(x * MM, y * MM, math.radians(heading))


def number(message: Mapping[str, Any], name: str) -> float | None:
    """A finite number of a message that may hold anything."""
    value = message.get(name)
    if isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value):
        return float(value)
    return None


def count(message: Mapping[str, Any], name: str) -> int:
    return int(number(message, name) or 0)
