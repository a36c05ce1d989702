"""The figure of lines: a metric over one axis, with intervals."""

from __future__ import annotations

import math
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from control.studies.analysis.curves import Curve, Panel, panels
from control.studies.analysis.samples import Samples, is_number
from server.reports.drawing import grid, label
from server.reports.study.layout import MOST_LINES, MOST_PANELS, Layout, spread
from server.reports.study.naming import axis_name, axis_title, short_metric, value_text

WIDTH, HEIGHT = 3.3, 2.6
"""Of one panel, inches."""
MARKS = "osD^vP<>"
BESIDE = 0.07
"""Room on either side, as a share of the axis."""
MOST_TICKS = 8
"""Levels that are written below the axis; more would touch."""
ASIDE = 0.012
"""Lines are set apart by this share of the axis, so that their intervals do not hide each other."""


def lines(samples: Samples, layout: Layout) -> Figure:
    """One panel for each value of the panel's axis; all share the scale of the metric."""
    chosen = spread(panels(samples, layout.x, layout.line, layout.panel), MOST_PANELS)
    rows, columns = shape(len(chosen))
    size = (max(WIDTH * columns + 0.6, 5.6), max(HEIGHT * rows + 0.5, 3.4))
    figure, axes = grid(rows, columns, size)
    for one, panel in zip(axes, chosen, strict=False):
        _panel(one, samples, layout, panel)
    _share_scale(axes[: len(chosen)])
    for spare in axes[len(chosen) :]:
        spare.set_axis_off()
    _legend(figure, axes[: len(chosen)], samples, layout)
    return figure


def shape(count: int) -> tuple[int, int]:
    """Rows and columns for so many panels."""
    columns = min(count, 3 if count != 4 else 2)
    return math.ceil(count / columns), columns


def colours(count: int) -> list[Any]:
    """From dark to light, in an order that survives print and most colour blindness."""
    return list(matplotlib.colormaps["viridis"](np.linspace(0.0, 0.85, max(count, 1))))


def _panel(axes: Axes, samples: Samples, layout: Layout, panel: Panel) -> None:
    looks = _looks(samples, layout)
    for curve in panel.curves:
        if curve.value in looks:
            _curve(axes, samples, layout, curve, looks[curve.value])
    title = (
        "" if layout.panel is None else f"{axis_name(layout.panel)} {value_text(layout.panel, panel.value)}"
    )
    label(axes, axis_title(layout.x), short_metric(samples.metric), title)
    axes.grid(axis="y", color="#e6e6e6", linewidth=0.6)
    levels = samples.levels(layout.x)
    if samples.numeric(layout.x):
        room = BESIDE * (float(levels[-1]) - float(levels[0]) or 1.0)
        axes.set_xlim(levels[0] - room, levels[-1] + room)
        if len(levels) <= MOST_TICKS:
            axes.set_xticks(levels)
    else:
        axes.set_xticks(range(len(levels)), [value_text(layout.x, level) for level in levels], fontsize=8)
        axes.margins(x=0.2)


def _looks(samples: Samples, layout: Layout) -> dict[Any, tuple[Any, str, float]]:
    """Colour, mark and place aside of each line: a value has the same in every panel, whatever that lacks."""
    values = [None] if layout.line is None else spread(samples.levels(layout.line), MOST_LINES)
    middle = 0.5 * (len(values) - 1)
    return {
        value: (colour, MARKS[place % len(MARKS)], ASIDE * (place - middle))
        for place, (value, colour) in enumerate(zip(values, colours(len(values)), strict=True))
    }


def _curve(axes: Axes, samples: Samples, layout: Layout, curve: Curve, look: tuple[Any, str, float]) -> None:
    colour, mark, aside = look
    levels = samples.levels(layout.x)
    span = float(levels[-1] - levels[0]) if samples.numeric(layout.x) else len(levels) - 1.0
    x = np.array([_place(levels, value) for value in curve.x]) + aside * span
    means = np.array([one.value for one in curve.means])
    reach = np.array([[one.value - one.low, one.high - one.value] for one in curve.means]).T
    axes.errorbar(
        x, means, yerr=np.nan_to_num(reach), color=colour, marker=mark, markersize=3.5, linewidth=1.1,
        elinewidth=0.9, capsize=1.5, linestyle="-" if samples.numeric(layout.x) else "none",
        label="" if layout.line is None else value_text(layout.line, curve.value),
    )  # fmt: skip


def _place(levels: list[Any], value: Any) -> float:
    return float(value) if all(is_number(level) for level in levels) else float(levels.index(value))


def _share_scale(axes: list[Axes]) -> None:
    limits = np.array([one.get_ylim() for one in axes])
    low, high = float(limits[:, 0].min()), float(limits[:, 1].max())
    for one in axes:
        one.set_ylim(max(low, 0.0) if low > -0.05 * (high - low) else low, high)


def _legend(figure: Figure, panels: list[Axes], samples: Samples, layout: Layout) -> None:
    if layout.line is None:
        return
    drawn = {
        name: handle
        for axes in panels
        for handle, name in zip(*axes.get_legend_handles_labels(), strict=True)
    }
    names = (value_text(layout.line, value) for value in _looks(samples, layout))
    labels = [name for name in names if name in drawn]
    handles = [drawn[name] for name in labels]
    if handles:
        figure.legend(
            handles, labels, loc="outside lower center", ncols=min(len(labels), 8), fontsize=8, frameon=False,
            title=axis_name(layout.line), title_fontsize=8,
        )  # fmt: skip
