"""The report's pictures, drawn with matplotlib and without a display."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from server.reports.drawing import BLACK, BLUE, GREEN, MM, ORANGE, PURPLE, grid, label
from server.reports.locomotion import PATH_DISTANCE, STEP_DISTANCE, Locomotion, StraightPath
from server.reports.simulation import GB, OB, PLANNER, SWEEPS_DEG, Result, Simulation, reference

COLOURS = {GB: ORANGE, OB: BLUE, PLANNER: GREEN}
DASHES = {GB: "-", OB: (0, (4, 1.5)), PLANNER: "-"}


def paths(found: Locomotion) -> Figure:
    """Straight walks at several sweep angles: the centre, both ends, and the line."""
    figure, axes = grid(3, 2, (8.0, 8.2))
    for one, path in zip(axes, found.paths, strict=True):
        _straight_path(one, path)
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, fontsize=8, frameon=False)
    return figure


def _straight_path(axes: Axes, path: StraightPath) -> None:
    for points, colour, name in ((path.a, BLUE, "end A"), (path.b, ORANGE, "end B")):
        axes.plot(*(points.T / MM), color=colour, linewidth=0.8, label=name)
    axes.plot(*(path.centre.T / MM), color=BLACK, linewidth=1.6, label="centre")
    axes.plot(
        [0.0, PATH_DISTANCE / MM], [0.0, 0.0], color=PURPLE, linestyle="--", linewidth=1.0, label="line"
    )
    axes.set_aspect("equal", adjustable="datalim")
    label(axes, "x, mm", "y, mm", f"sweep {path.sweep_deg:.0f}°: {path.steps} steps")


def steps(found: Locomotion) -> Figure:
    figure, (axes,) = grid(1, 1, (7.0, 3.6))
    sweeps = [cost.sweep_deg for cost in found.costs]
    axes.step(sweeps, [cost.steps for cost in found.costs], where="mid", color=BLUE, linewidth=1.4)
    axes.set_yscale("log")
    axes.set_xticks(range(0, 361, 45))
    axes.grid(axis="y", which="major", color="#dddddd", linewidth=0.6)
    label(axes, "sweep angle, °", f"steps for {STEP_DISTANCE / MM:.0f} mm")
    return figure


def travel(found: Locomotion) -> Figure:
    figure, (axes,) = grid(1, 1, (7.0, 3.6))
    sweeps = np.array([cost.sweep_deg for cost in found.costs])
    axes.plot(
        sweeps,
        [cost.travelled / MM for cost in found.costs],
        color="#9ac4de",
        linewidth=1.0,
        label="walked, whole steps",
    )
    axes.plot(
        sweeps, [cost.travel / MM for cost in found.costs], color=BLUE, linewidth=1.4, label="closed form"
    )
    axes.axhline(STEP_DISTANCE / MM, color=PURPLE, linestyle="--", linewidth=1.0, label="the straight line")
    axes.set_yscale("log")
    axes.set_xticks(range(0, 361, 45))
    axes.legend(fontsize=8, frameon=False)
    label(axes, "sweep angle, °", "way of the centre, mm")
    return figure


def eights(found: Simulation) -> Figure:
    """The walks along the eight, one picture for each sweep angle."""
    figure, axes = grid(1, 2, (9.0, 5.0))
    for one, sweep_deg in zip(axes, SWEEPS_DEG, strict=True):
        shown = _shown(found, sweep_deg)
        one.plot(*(reference(len(shown[0].error)).T / MM), color=BLACK, linewidth=1.0, label="reference")
        _lines(one, shown, lambda result: result.centre.T / MM)
        one.plot(*(shown[0].centre[0] / MM), "o", color=PURPLE, markersize=5, label="start")
        one.set_aspect("equal")
        label(one, "x, mm", "y, mm", f"sweep {sweep_deg}°")
    figure.legend(
        *axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=5, fontsize=8, frameon=False
    )
    return figure


def errors(found: Simulation) -> Figure:
    """Distance from the reference over time."""
    figure, axes = grid(2, 1, (8.0, 5.6))
    for one, sweep_deg in zip(axes, SWEEPS_DEG, strict=True):
        shown = _shown(found, sweep_deg)
        _lines(one, shown, lambda result: (0.1 * np.arange(len(result.error)), result.error / MM))
        one.set_ylim(bottom=0.0)
        label(one, "time, s", "error, mm", f"sweep {sweep_deg}°")
    axes[0].legend(fontsize=8, frameon=False, ncols=3)
    return figure


def choices(found: Simulation) -> Figure:
    """Mean error over completed sweeps: what a smaller error costs."""
    figure, axes = grid(1, 2, (9.0, 3.8))
    for one, sweep_deg in zip(axes, SWEEPS_DEG, strict=True):
        for results, colour, name in (
            (found.gains, ORANGE, "Gb, gains 1 to 12"),
            (found.choices, GREEN, "planner, cost of a sweep 0 to 3"),
            (found.early, PURPLE, "planner with early ends, cost of a sweep 0 to 0.3"),
        ):
            points = _points(results, sweep_deg)
            one.plot(*points.T, "o", color=colour, markersize=4, label=name)
        metrics = found.of(OB, sweep_deg).metrics
        one.plot(metrics.sweeps, metrics.mean_error / MM, "s", color=BLUE, markersize=5, label="Ob")
        one.set_yscale("log")
        one.margins(x=0.15)
        label(one, "completed sweeps", "mean error, mm", f"sweep {sweep_deg}°")
    figure.legend(
        *axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize=8, frameon=False
    )
    return figure


def _shown(found: Simulation, sweep_deg: int) -> list[Result]:
    return [found.of(label, sweep_deg) for label in (GB, OB, PLANNER)]


def _lines(
    axes: Axes,
    results: list[Result],
    data: Callable[[Result], Iterable[NDArray[Any]]],
) -> None:
    for result in results:
        label = result.case.label
        axes.plot(*data(result), color=COLOURS[label], linestyle=DASHES[label], linewidth=1.1, label=label)


def _points(results: tuple[Result, ...], sweep_deg: int) -> NDArray[np.float64]:
    """(n, 2): completed sweeps and mean error (mm)."""
    chosen = [result.metrics for result in results if result.case.sweep_deg == sweep_deg]
    return np.array([(metrics.sweeps, metrics.mean_error / MM) for metrics in chosen])
