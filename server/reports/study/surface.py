"""The picture of what an auto-tune has learned: the error expected over one or two axes, and the runs behind it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from control.studies.tuning.answer import NORMAL_95
from control.studies.tuning.surface import Surface
from server.reports.drawing import BLACK, BLUE, ORANGE, grid, label
from server.reports.study.naming import axis_title, metric_title, short_metric

LEVELS = 12
"""Steps of colour: few enough to find one again beside the picture."""


def draw_surface(surface: Surface) -> Figure:
    """A line with its band for one axis; for two, the error and how uncertain it is, side by side."""
    return _line(surface) if len(surface.axes) == 1 else _maps(surface)


def _line(surface: Surface) -> Figure:
    figure, (axes,) = grid(1, 1, (7.0, 3.8))
    (name,), (marks,) = surface.axes, surface.marks
    places, reach = _places(marks), NORMAL_95 * surface.deviation
    axes.fill_between(places, surface.mean - reach, surface.mean + reach, color=BLUE, alpha=0.18, linewidth=0)
    axes.plot(places, surface.mean, color=BLUE, linewidth=1.4, label="expected, with 95 %")
    _named(axes, marks)
    done = [sample for sample in surface.samples if sample.error is not None]
    across = [_place(marks, sample.values[name]) for sample in done]
    axes.plot(across, [sample.error or 0.0 for sample in done], ".", color=BLACK, markersize=4, label="runs")
    axes.axvline(_place(marks, surface.best[name]), color=ORANGE, linewidth=1.2, label="best")
    axes.legend(fontsize=8, frameon=False)
    label(axes, axis_title(name), metric_title(surface.metric))
    return figure


def _maps(surface: Surface) -> Figure:
    figure, axes = grid(1, 2, (10.0, 4.2))
    titles = (f"expected {short_metric(surface.metric)}", "uncertainty of that (standard deviation)")
    for one, heights, title in zip(axes, (surface.mean, surface.deviation), titles, strict=True):
        _map(figure, one, surface, heights)
        label(one, axis_title(surface.axes[0]), axis_title(surface.axes[1]), title)
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, fontsize=8, frameon=False)
    return figure


def _map(figure: Figure, axes: Axes, surface: Surface, heights: np.ndarray) -> None:
    right, up = surface.marks
    filled = axes.pcolormesh(
        _places(right), _places(up), heights, cmap="cividis", shading="nearest", rasterized=True
    )
    figure.colorbar(filled, ax=axes).ax.tick_params(labelsize=8)
    for failed, mark, name in ((False, "o", "runs"), (True, "x", "failed runs")):
        _scatter(axes, surface, failed, mark, name)
    best = [
        _place(marks, surface.best[name]) for name, marks in zip(surface.axes, surface.marks, strict=True)
    ]
    axes.plot(
        *best, "*", color=ORANGE, markeredgecolor="white", markersize=15, label="best", linestyle="none"
    )
    _named(axes, right, up)


def _scatter(axes: Axes, surface: Surface, failed: bool, mark: str, name: str) -> None:
    """Runs off the section that is drawn are shown where they are over its axes."""
    shown = [sample for sample in surface.samples if (sample.error is None) == failed]
    points = [
        [_place(marks, sample.values[axis]) for axis, marks in zip(surface.axes, surface.marks, strict=True)]
        for sample in shown
    ]
    if points:
        across, up = np.array(points).T
        axes.plot(
            across, up, mark, color="white", markeredgecolor=BLACK, markersize=4, label=name, linestyle="none"
        )


def _places(marks: Sequence[Any]) -> np.ndarray:
    """Numbers where they are, words one after the other."""
    return np.array([_place(marks, mark) for mark in marks], dtype=float)


def _place(marks: Sequence[Any], value: Any) -> float:
    return float(value) if _are_numbers(marks) else float(list(marks).index(value))


def _are_numbers(marks: Sequence[Any]) -> bool:
    return all(isinstance(mark, int | float) and not isinstance(mark, bool) for mark in marks)


def _named(axes: Axes, right: Sequence[Any], up: Sequence[Any] = (0.0,)) -> None:
    if not _are_numbers(right):
        axes.set_xticks(range(len(right)), [str(word) for word in right])
    if not _are_numbers(up):
        axes.set_yticks(range(len(up)), [str(word) for word in up])
