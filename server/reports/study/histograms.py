"""The figure of distributions: histograms of single runs with the fitted laws over them."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from control.studies.analysis.distribution import Distribution
from server.reports.drawing import BLACK, BLUE, GREEN, ORANGE, PURPLE, grid, label
from server.reports.study.lines import shape
from server.reports.study.naming import number

COLOURS = (ORANGE, BLUE, GREEN, PURPLE)
FINE = 300
MOST_BINS = 30
ROOM = 1.25
"""Of the highest bar, so that the legend has a place above it."""


def histograms(panels: Mapping[str, Mapping[str, Distribution]], metric: str) -> Figure:
    """panels: title -> name of the law's runs (a controller, say) -> its distribution; at most four in a panel."""
    rows, columns = shape(len(panels))
    figure, axes = grid(rows, columns, (max(3.5 * columns, 5.6), max(2.8 * rows, 3.2)))
    edges = _edges(panels)
    for one, (title, found) in zip(axes, panels.items(), strict=False):
        for colour, (name, distribution) in zip(COLOURS, found.items(), strict=False):
            _histogram(one, distribution, (colour, name, edges))
        label(one, metric, "runs", title)
        one.set_ylim(top=ROOM * one.get_ylim()[1])
        one.legend(fontsize=7, frameon=False, loc="upper left")
    for spare in axes[len(panels) :]:
        spare.set_axis_off()
    figure.legend(
        *_laws(axes[0]), loc="outside lower center", ncols=2, fontsize=8, frameon=False,
    )  # fmt: skip
    return figure


def _edges(panels: Mapping[str, Mapping[str, Distribution]]) -> np.ndarray:
    """The same bins everywhere, so that panels compare; Freedman and Diaconis' width, not more than MOST_BINS."""
    values = np.concatenate([one.values for found in panels.values() for one in found.values()])
    if not len(values) or not np.ptp(values) > 0.0:
        return (
            np.linspace(0.0, 1.0, 2)
            if not len(values)
            else values[0] + 0.05 * values[0] * np.array([-1.0, 1.0])
        )
    widths = [
        2.0 * (np.quantile(one.values, 0.75) - np.quantile(one.values, 0.25)) / np.cbrt(len(one.values))
        for found in panels.values()
        for one in found.values()
        if len(one.values) > 1
    ]
    width = max(min(widths, default=0.0), float(np.ptp(values)) / (2 * MOST_BINS), np.finfo(float).tiny)
    count = max(int(np.ceil(np.ptp(values) / width)), 4)
    return np.linspace(values.min(), values.max(), min(count, 2 * MOST_BINS) + 1)


def _histogram(axes: Axes, found: Distribution, look: tuple[str, str, np.ndarray]) -> None:
    colour, name, edges = look
    text = f"{name}: mean {number(found.mean.value)}, n = {len(found.values)}"
    axes.hist(found.values, bins=list(edges), color=colour, alpha=0.35, label=text)
    x = np.linspace(edges[0], edges[-1], FINE)
    height = len(found.values) * (edges[1] - edges[0])
    if found.weibull is not None:
        axes.plot(x, height * found.weibull.law.density(x), color=colour, linewidth=1.4)
    if found.located is not None:
        axes.plot(x, height * found.located.law.density(x), color=colour, linewidth=1.0, linestyle=":")


def _laws(axes: Axes) -> tuple[list[Artist], list[str]]:
    whole = axes.plot([], [], color=BLACK, linewidth=1.4)[0]
    dotted = axes.plot([], [], color=BLACK, linewidth=1.0, linestyle=":")[0]
    return [whole, dotted], ["Weibull from 0", "Weibull with a location of its own"]
