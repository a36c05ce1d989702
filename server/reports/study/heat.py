"""The heat map: a metric over two axes, a panel for each value of a third."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from numpy.typing import NDArray

from control.studies.analysis.curves import split
from control.studies.analysis.intervals import mean_of_means
from control.studies.analysis.samples import Samples, is_number
from server.reports.drawing import grid, label
from server.reports.study.layout import MOST_PANELS, Layout, spread
from server.reports.study.lines import shape
from server.reports.study.naming import axis_name, axis_title, number, short_metric, value_text

COLOURS = "viridis_r"
"""Dark is worse; even steps of lightness, also in grey and for most colour-blind people."""
MOST_WRITTEN = 120
"""Cells of one panel with their numbers in them."""
DARK = 0.45
"""Of the scale: above it, numbers are white."""


def heat(samples: Samples, layout: Layout) -> Figure:
    """layout.line is the axis that goes up. All panels share the colours."""
    parts = spread(split(samples, layout.panel), MOST_PANELS)
    maps = [cells(part, samples, layout) for _, part in parts]
    rows, columns = shape(len(parts))
    across, up = len(samples.levels(layout.x)), len(samples.levels(str(layout.line)))
    width = min(max(0.52 * across + 1.2, 3.2), 11.0 / columns)
    figure, axes = grid(rows, columns, (width * columns + 0.8, min(max(0.42 * up + 1.1, 2.4), 6.0) * rows))
    scale = _scale(maps)
    for one, (value, _), heights in zip(axes, parts, maps, strict=False):
        _map(one, samples, layout, (value, heights, scale))
    for spare in axes[len(parts) :]:
        spare.set_axis_off()
    drawn = ScalarMappable(scale, COLOURS)
    bar = figure.colorbar(drawn, ax=axes[: len(parts)], shrink=0.9)
    bar.set_label(short_metric(samples.metric), fontsize=9)
    bar.ax.tick_params(labelsize=8)
    return figure


def cells(part: Samples, whole: Samples, layout: Layout) -> NDArray[np.float64]:
    """Means, (values of line, values of x); NaN where nothing finished. Axes not shown are averaged over."""
    assert layout.line is not None
    x, y = whole.levels(layout.x), whole.levels(layout.line)
    means = np.full((len(y), len(x)), math.nan)
    for row, high in enumerate(y):
        for column, right in enumerate(x):
            groups = part.only({layout.line: high, layout.x: right}).groups()
            means[row, column] = mean_of_means(groups).value
    return means


def _scale(maps: list[NDArray[np.float64]]) -> Normalize:
    known = np.concatenate([one[np.isfinite(one)] for one in maps])
    return Normalize(float(known.min()), float(known.max())) if len(known) else Normalize(0.0, 1.0)


def _map(
    axes: Axes, samples: Samples, layout: Layout, content: tuple[Any, NDArray[np.float64], Normalize]
) -> None:
    value, heights, scale = content
    assert layout.line is not None
    axes.imshow(heights, origin="lower", aspect="auto", cmap=COLOURS, norm=scale, interpolation="nearest")
    x, y = samples.levels(layout.x), samples.levels(layout.line)
    axes.set_xticks(range(len(x)), [_short(layout.x, level) for level in x], fontsize=8)
    axes.set_yticks(range(len(y)), [_short(layout.line, level) for level in y], fontsize=8)
    if heights.size <= MOST_WRITTEN:
        _write(axes, heights, scale)
    title = "" if layout.panel is None else f"{axis_name(layout.panel)} {value_text(layout.panel, value)}"
    label(axes, axis_title(layout.x), axis_title(layout.line), title)


def _write(axes: Axes, heights: NDArray[np.float64], scale: Normalize) -> None:
    for (row, column), height in np.ndenumerate(heights):
        known = math.isfinite(height)
        dark = known and float(scale(height)) > DARK
        axes.text(
            column, row, number(height, 2) if known else "×", ha="center", va="center", fontsize=7,
            color="white" if dark else "black",
        )  # fmt: skip


def _short(axis: str, level: Any) -> str:
    return (
        f"{level:.4g}"
        if isinstance(level, float)
        else str(level)
        if is_number(level)
        else value_text(axis, level)
    )
