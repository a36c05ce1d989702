"""The one figure that fits a study's axes."""

from __future__ import annotations

from matplotlib.figure import Figure

from control.studies.analysis.distribution import describe
from control.studies.analysis.samples import Samples, samples
from control.studies.definition import StudyDefinition
from control.studies.table import StudyTable
from server.reports.drawing import grid, png
from server.reports.study.heat import heat
from server.reports.study.histograms import histograms
from server.reports.study.layout import heat_layout, line_layouts
from server.reports.study.lines import lines
from server.reports.study.naming import metric_title
from server.reports.study.scatter import scatter


def plot_png(table: StudyTable, definition: StudyDefinition) -> bytes:
    """Lines for one axis, a heat map for two, panels of it for three; points where the sets are scattered."""
    return png(plotted(samples(table.rows, definition.axis_names)))


def plotted(found: Samples) -> Figure:
    if not len(found.points):
        return notice("No run is over yet.")
    varied = found.varied()
    if not varied:
        return _one_set(found)
    if found.scattered:
        return scatter(found)
    layout = heat_layout(found)
    return lines(found, line_layouts(found)[0]) if layout is None else heat(found, layout)


def _one_set(found: Samples) -> Figure:
    distribution = describe(found.value)
    if not len(distribution.values):
        return notice("No run has finished.")
    return histograms({"": {"runs": distribution}}, metric_title(found.metric))


def notice(words: str) -> Figure:
    """A figure that says why there is none."""
    figure, (axes,) = grid(1, 1, (5.6, 1.6))
    axes.set_axis_off()
    axes.text(0.5, 0.5, words, ha="center", va="center", fontsize=11)
    return figure
