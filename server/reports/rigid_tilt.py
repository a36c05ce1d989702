"""The rigid robot over the tilt: what its pivot switches do, for each Lambda, as a figure and as tables."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from control.simulation.gait_survey import Spread
from control.simulation.rigid.tilt_study import TableRow, TiltPoint
from server.reports.drawing import MM, grid, label
from server.reports.tables import Table

WIDTH, HEIGHT = 4.0, 2.3
"""Of one panel, inches."""
MARKS = "osD^vP<>"

NOTES = (
    "Where the free end lifts only above Λ sin α = 1 (dotted), a weaker field leaves both ends on the plate, and "
    "friction holds the body back: it sticks, as play in its heading.",
    "A strong magnet makes the new pivot hop outward at the switch, up to 30° the more the higher the tilt; there a "
    "ramp three times as long nearly removes that, but not where a weaker one tears the ends off against their "
    "adhesion (Λ = 2.6).",
    "So there can be a best tilt in between, and its place follows from Λ: it is a property of the assumed robot "
    "(79 mg, 0.3 mN of adhesion at each end, friction 0.4 ± 20 % in patches of 1 mm, feet of two balls 2 mm apart) "
    "and predicts nothing of the paper's. The slip table was fitted at Λ = 3.2; this plant's default is Λ = 2.6.",
)
"""What is to be said wherever the figure is shown."""


@dataclass(frozen=True, slots=True)
class _Quantity:
    title: str
    of: Callable[[TiltPoint], Spread]
    scale: float


QUANTITIES = (
    _Quantity("play of the heading, °", lambda point: point.figures.play, math.degrees(1.0)),
    _Quantity("outward hop at a switch, mm", lambda point: point.figures.hop, 1.0 / MM),
    _Quantity("slip of a pivot per sweep, mm", lambda point: point.figures.displacement, 1.0 / MM),
)


def rigid_tilt(points: Sequence[TiltPoint]) -> Figure:
    """A row of panels for each quantity, a column for each ramp, a line for each Lambda; bars: one deviation."""
    ramps, ratios = sorted({point.ramp for point in points}), sorted({point.ratio for point in points})
    rows, columns = len(QUANTITIES), len(ramps)
    figure, axes = grid(rows, columns, (WIDTH * columns, HEIGHT * rows + 0.5))
    colours = matplotlib.colormaps["viridis"](np.linspace(0.0, 0.85, len(ratios)))
    for row, quantity in enumerate(QUANTITIES):
        panels = axes[row * columns : (row + 1) * columns]
        for panel, ramp in zip(panels, ramps, strict=True):
            for place, ratio in enumerate(ratios):
                line = [point for point in points if (point.ramp, point.ratio) == (ramp, ratio)]
                _line(panel, quantity, line, (colours[place], MARKS[place % len(MARKS)]))
            title = f"elevation ramp {1e3 * ramp:.0f} ms" if row == 0 else ""
            label(panel, "tilt α, °" if row == rows - 1 else "", quantity.title, title)
            panel.grid(axis="y", color="#e6e6e6", linewidth=0.6)
        _share_scale(panels)
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels), fontsize=8, frameon=False)
    return figure


def _line(axes: Axes, quantity: _Quantity, points: Sequence[TiltPoint], look: tuple[object, str]) -> None:
    colour, mark = look
    ordered = sorted(points, key=lambda point: point.tilt)
    spreads = [quantity.of(point) for point in ordered]
    axes.errorbar(
        [math.degrees(point.tilt) for point in ordered],
        [quantity.scale * spread.mean for spread in spreads],
        yerr=[quantity.scale * spread.deviation for spread in spreads],
        color=colour, marker=mark, markersize=3.5, linewidth=1.1, elinewidth=0.8, capsize=1.5,
        label=f"Λ = {ordered[0].ratio:g}",
    )  # fmt: skip
    lifting = math.degrees(math.asin(min(1.0, 1.0 / ordered[0].ratio)))
    if math.degrees(ordered[0].tilt) <= lifting <= math.degrees(ordered[-1].tilt):
        axes.axvline(lifting, color=colour, linewidth=0.8, linestyle=":")  # type: ignore[arg-type]


def _share_scale(panels: Sequence[Axes]) -> None:
    low = min(panel.get_ylim()[0] for panel in panels)
    high = max(panel.get_ylim()[1] for panel in panels)
    for panel in panels:
        panel.set_ylim(low, high)


def tilt_table(points: Sequence[TiltPoint]) -> Table:
    header = (
        "lambda", "ramp_ms", "tilt_deg", "lambda_sin_tilt", "body_tilt_deg", "play_deg", "play_sd_deg", "hop_mm",
        "hop_sd_mm", "out_mm", "out_sd_mm", "forward_mm", "forward_sd_mm", "advance_share",
    )  # fmt: skip
    return [header, *(_row(point) for point in points)]


def _row(point: TiltPoint) -> tuple[float, ...]:
    figures = point.figures
    return (
        point.ratio,
        round(1e3 * point.ramp, 6),
        round(math.degrees(point.tilt), 6),
        round(point.lift, 4),
        round(math.degrees(figures.tilt.mean), 3),
        *_in_degrees(figures.play),
        *_in_mm(figures.hop),
        *_in_mm(figures.out),
        *_in_mm(figures.forward),
        round(figures.advance, 4),
    )


def beside_table(rows: Sequence[TableRow], sweep: float) -> Table:
    """The slip table's rows beside the rigid plant's at the same Lambda, for one sweep (rad); nothing was fitted."""
    header = (
        "tilt_deg", "play_table_deg", "play_table_sd_deg", "play_rigid_deg", "play_rigid_sd_deg", "out_table_mm",
        "out_table_sd_mm", "out_rigid_mm", "out_rigid_sd_mm", "forward_table_mm", "forward_table_sd_mm",
        "forward_rigid_mm", "forward_rigid_sd_mm",
    )  # fmt: skip
    return [header, *(_beside(row, sweep) for row in rows)]


def _beside(row: TableRow, sweep: float) -> tuple[float, ...]:
    table, rigid = row.table, row.rigid
    forward = table.forward_base + table.forward_per_sweep * sweep
    return (
        round(math.degrees(table.tilt), 6),
        *_in_degrees(Spread(table.play, table.play_sd)),
        *_in_degrees(rigid.play),
        *_in_mm(Spread(table.out, table.out_sd)),
        *_in_mm(rigid.out),
        *_in_mm(Spread(forward, table.forward_sd)),
        *_in_mm(rigid.forward),
    )


def _in_mm(spread: Spread) -> tuple[float, float]:
    return round(spread.mean / MM, 4), round(spread.deviation / MM, 4)


def _in_degrees(spread: Spread) -> tuple[float, float]:
    return round(math.degrees(spread.mean), 3), round(math.degrees(spread.deviation), 3)
