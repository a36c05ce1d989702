"""The figure of paths: where the centre went in one run of each of a few sets, beside the reference."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from textwrap import fill

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from server.reports.drawing import BLACK, MM, ORANGE, grid, label

TITLE = 38
"""Letters of a title beside the next one."""
MARGIN = 4.0
"""Around the paths, mm."""


@dataclass(frozen=True, slots=True)
class Walked:
    """title: of the set.  reference, centre: (n, 2) positions, workspace frame, m.  error: ME of this run."""

    title: str
    reference: NDArray[np.float64]
    centre: NDArray[np.float64]
    error: float


def trajectories(walks: Sequence[Walked], columns: int) -> Figure:
    """columns: how many sets stand side by side; all have the same scale."""
    rows = -(-len(walks) // columns)
    figure, axes = grid(rows, columns, (max(2.7 * columns, 4.0), 2.9 * rows + 0.3))
    low, high = _limits(walks)
    for one, walk in zip(axes, walks, strict=False):
        _walk(one, walk)
        one.set_xlim(low[0], high[0])
        one.set_ylim(low[1], high[1])
        one.set_aspect("equal")
        label(one, "x, mm", "y, mm")
        one.set_title(f"{fill(walk.title, TITLE)}\nME {walk.error:.3g}", fontsize=8, loc="left")
    for spare in axes[len(walks) :]:
        spare.set_axis_off()
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, fontsize=8, frameon=False)
    return figure


def _limits(walks: Sequence[Walked]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Lower left and upper right corner of all paths, mm."""
    points = np.concatenate([part for walk in walks for part in (walk.reference, walk.centre)]) / MM
    return points.min(axis=0) - MARGIN, points.max(axis=0) + MARGIN


def _walk(axes: Axes, walk: Walked) -> None:
    axes.plot(*(walk.reference.T / MM), color=ORANGE, linewidth=1.6, label="reference")
    axes.plot(*(walk.centre.T / MM), color=BLACK, linewidth=0.8, label="centre")
    axes.plot(*(walk.centre[-1] / MM), "s", color=BLACK, markersize=4, label="end")
