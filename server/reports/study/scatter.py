"""The figure of scattered points: a metric over each axis, a point for each set."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from control.studies.analysis.intervals import mean_interval
from control.studies.analysis.samples import MOST_LEVELS, Samples
from server.reports.drawing import BLACK, BLUE, ORANGE, grid, label
from server.reports.study.layout import MOST_PANELS
from server.reports.study.lines import shape
from server.reports.study.naming import axis_title, short_metric, value_text


def scatter(samples: Samples) -> Figure:
    """Each axis that varies has a panel; the best set is marked in all of them."""
    varied = samples.varied()[:MOST_PANELS]
    rows, columns = shape(len(varied))
    figure, axes = grid(rows, columns, (max(3.3 * columns, 5.6), max(2.7 * rows, 3.2)))
    means = np.array([mean_interval(group).value for group in samples.groups()])
    for one, axis in zip(axes, varied, strict=False):
        x, names = _places(samples, axis)
        one.plot(x, means, "o", color=BLUE, markersize=3.5, alpha=0.7, label="sets")
        if np.any(np.isfinite(means)):
            best = int(np.nanargmin(means))
            one.plot(
                x[best], means[best], "D", color=ORANGE, markeredgecolor=BLACK, markersize=6, label="best"
            )
        if names:
            one.set_xticks(
                range(len(names)), names[:MOST_LEVELS] + [""] * (len(names) - MOST_LEVELS), fontsize=8
            )
            one.margins(x=0.2)
        label(one, axis_title(axis), short_metric(samples.metric))
    for spare in axes[len(varied) :]:
        spare.set_axis_off()
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=2, fontsize=8, frameon=False)
    return figure


def _places(samples: Samples, axis: str) -> tuple[Any, list[str]]:
    if samples.numeric(axis):
        return samples.numbers(axis), []
    levels = samples.levels(axis)
    return np.array([levels.index(value) for value in samples.column(axis)], dtype=float), [
        value_text(axis, one) for one in levels
    ]
