"""All figures of a study's report, with what each shows."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from matplotlib.figure import Figure

from control.studies.analysis.distribution import Distribution
from control.studies.analysis.whole import Analysis
from control.studies.definition import StudyDefinition
from control.studies.table import StudyTable
from server.reports.study.heat import heat
from server.reports.study.histograms import histograms
from server.reports.study.layout import MOST_LINES, MOST_PANELS, Layout, heat_layout, line_layouts
from server.reports.study.lines import lines
from server.reports.study.naming import axis_name, metric_title, point_text, short_metric, value_text
from server.reports.study.plot import plotted
from server.reports.study.scatter import scatter
from server.reports.study.trajectories import trajectories
from server.reports.study.walks import Source, paths

MOST_HISTOGRAMS = 12
MOST_LAWS = 4
"""In one panel: more cannot be told apart."""


@dataclass(frozen=True, slots=True)
class Drawn:
    """name: of its files.  caption: what to see."""

    name: str
    caption: str
    figure: Figure


def measured(found: Analysis) -> Iterator[Drawn]:
    """The metric over the axes."""
    samples = found.samples
    if not samples.varied() or found.best is None:
        yield Drawn("runs", f"{metric_title(samples.metric)} of the single runs.", plotted(samples))
        return
    if samples.scattered:
        yield Drawn("sets", f"{metric_title(samples.metric)} of each set over each axis.", scatter(samples))
        return
    for layout in line_layouts(samples):
        yield Drawn(_name("lines", layout), _caption(samples.metric, layout), lines(samples, layout))
    layout = heat_layout(samples)
    if layout is not None:
        caption = f"The same as colours: dark is worse.{_limits(layout)}"
        yield Drawn(_name("heat", layout), caption, heat(samples, layout))


def distributed(found: Analysis) -> Iterator[Drawn]:
    """Histograms of the sets with many runs."""
    panels = _panels(found)
    if panels:
        shown = dict(list(panels.items())[:MOST_HISTOGRAMS])
        caption = "How single runs scatter, with the Weibull laws of the highest likelihood."
        if len(panels) > len(shown):
            caption += f" {len(shown)} of {len(panels)} panels are shown; the table has all."
        yield Drawn("distributions", caption, histograms(shown, metric_title(found.samples.metric)))


def walked(found: Analysis, table: StudyTable, source: Source | None) -> Iterator[Drawn]:
    chosen = None if source is None else paths(found, table, source)
    if chosen is not None:
        caption = "The first finished run of some sets: where the centre went, and the reference."
        yield Drawn("paths", caption, trajectories(chosen.walks, chosen.columns))


def learned(definition: StudyDefinition, table: StudyTable) -> Iterator[Drawn]:
    """The surface that an auto-tune has learned."""
    if definition.design == "tune" and any(row.state == "finished" for row in table.rows):
        from control.studies.tuning import learned_surface
        from server.reports.study.surface import draw_surface

        surface = learned_surface(definition, {row.index: row for row in table.rows})
        if surface is not None:
            caption = "What the search has learned: the expected error and its uncertainty."
            yield Drawn("surface", caption, draw_surface(surface))


def _panels(found: Analysis) -> dict[str, dict[str, Distribution]]:
    """One panel for each point of the other axes, in it one histogram for each value of the axis of words."""
    words = next((axis for axis in found.samples.varied() if not found.samples.numeric(axis)), None)
    if words is not None and len(found.samples.levels(words)) > MOST_LAWS:
        words = None
    panels: dict[str, dict[str, Distribution]] = {}
    for place, one in found.distributions.items():
        point = dict(zip(found.samples.axes, found.samples.points[place], strict=True))
        name = "runs" if words is None else value_text(words, point[words])
        others = {axis: point[axis] for axis in found.samples.varied() if axis != words}
        panels.setdefault(point_text(others), {})[name] = one
    return panels


def _name(kind: str, layout: Layout) -> str:
    parts = [axis_name(axis).replace(" ", "-") for axis in (layout.x, layout.line) if axis is not None]
    return "-".join((kind, *parts))


def _caption(metric: str, layout: Layout) -> str:
    over = f"{short_metric(metric)} over {axis_name(layout.x)}"
    line = f", a line for each {axis_name(layout.line)}" if layout.line else ""
    panel = f", a panel for each {axis_name(layout.panel)}" if layout.panel else ""
    return f"{over}{line}{panel}; means with 95 % intervals.{_limits(layout)}"


def _limits(layout: Layout) -> str:
    names = " and ".join(axis_name(axis) for axis in layout.averaged)
    mean = f" Mean over {names}." if names else ""
    return f"{mean} At most {MOST_LINES} lines and {MOST_PANELS} panels are drawn." if names else mean
