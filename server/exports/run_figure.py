"""The figure of one run, as the paper draws its own: the path, the error over time, and how errors are distributed."""

from __future__ import annotations

import math
from array import array
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, BinaryIO

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from control.model import PIVOT_A, PIVOT_B
from server.exports.columns import named
from server.exports.formats import FormatName, Job, Watch
from server.exports.table import batches
from server.recording.reading.recording import Recording
from server.reports.drawing import BLACK, BLUE, GREEN, ORANGE, PURPLE, label, plain, png, svg

SHOWN = ("time_s", "x_mm", "y_mm", "x_reference_mm", "y_reference_mm", "error_mm", "run_s", "pivot")
BINS = 40
"""Of the distribution; an eight has some thousand errors."""
MOST_DRAWN = 60_000
"""Points of one line, a quarter of an hour's ticks: what a longer run has beside them would only fill the memory."""
SIZE = (10.0, 5.4)
"""Width and height, inches."""


@dataclass(frozen=True, slots=True)
class Walked:
    """Arrays (n,) over the ticks, NaN where something is unknown.

    time: since the first one, s.  walked: time walked so far, s; it stands still while the field ramps up and while
    the run is held.  The rest in mm.
    """

    time: NDArray[np.float64]
    x: NDArray[np.float64]
    y: NDArray[np.float64]
    x_reference: NDArray[np.float64]
    y_reference: NDArray[np.float64]
    error: NDArray[np.float64]
    walked: NDArray[np.float64]
    pivot: NDArray[np.float64]

    @property
    def errors(self) -> NDArray[np.float64]:
        """Those that count: of the ticks that walked, mm."""
        walks = np.diff(self.walked, prepend=np.inf) > 0.0
        return self.error[walks & np.isfinite(self.error)]

    def switches_to(self, pivot: int) -> NDArray[np.int_]:
        """Ticks at which that end became the pivot while a reference was followed."""
        changed = np.flatnonzero((self.pivot[1:] == pivot) & (self.pivot[:-1] == -pivot)) + 1
        return changed[np.isfinite(self.error[changed])]


@dataclass(frozen=True, slots=True)
class About:
    """What is written around the figure. mean: error of the whole run, mm; None for one without its end."""

    title: str
    subtitle: str
    mean: float | None

    @classmethod
    def of(cls, recording: Recording) -> About:
        outcome = recording.outcome or {}
        mean, normalized = (
            _found(outcome, "metrics", name) for name in ("mean_error_mm", "normalized_mean_error")
        )
        state = outcome.get("state") or ("" if recording.is_whole else "interrupted")
        which = f"{recording.started_at:%Y-%m-%d %H:%M:%S} UTC", f"{recording.duration:.1f} s", str(state)
        return cls(
            _title(recording.settings, normalized),
            "   ".join(filter(None, which)),
            mean if _are_numbers(mean) else None,
        )


def write(recording: Recording, sink: BinaryIO, job: Job, watch: Watch) -> None:
    figure = drawn(walked(recording, watch), About.of(recording))
    sink.write(svg(figure) if job.format == FormatName.SVG else png(figure))


def walked(recording: Recording, watch: Watch) -> Walked:
    columns = named(SHOWN)
    values = [array("d") for _ in columns]
    for rows in batches(recording, columns, watch):
        for series, found in zip(values, zip(*rows, strict=True), strict=True):
            series.extend(math.nan if value is None else value for value in found)
    time, *others = (np.asarray(series) for series in values)
    return Walked(time - time[:1], *others)


def drawn(run: Walked, about: About) -> Figure:
    figure = Figure(figsize=SIZE, layout="constrained")
    places = figure.subplot_mosaic([["path", "error"], ["path", "spread"]], width_ratios=[1.15, 1.0])
    for axes in places.values():
        plain(axes)
    _path(places["path"], run)
    _error(places["error"], run, about.mean)
    _spread(places["spread"], run)
    _line(figure.suptitle, about.title, fontsize=11)
    _line(figure.supxlabel, about.subtitle, fontsize=8, color="#555555")
    return figure


def _line(place: Callable[..., object], words: str, **looks: object) -> None:
    """On the left, as it is: a name may have signs that are no letters, and a dollar that is no formula."""
    shown = "".join(sign if sign.isprintable() else " " for sign in words)
    place(shown, x=0.01, horizontalalignment="left", parse_math=False, **looks)


def _path(axes: Axes, run: Walked) -> None:
    some = evenly(len(run.time))
    axes.plot(run.x_reference[some], run.y_reference[some], color=BLACK, linewidth=1.0, label="reference")
    axes.plot(run.x[some], run.y[some], color=GREEN, linewidth=1.2, label="robot")
    for pivot, colour, name in ((PIVOT_A, BLUE, "switch to A"), (PIVOT_B, ORANGE, "switch to B")):
        at = run.switches_to(pivot)
        axes.plot(run.x[at], run.y[at], ".", color=colour, markersize=4, label=name)
    axes.set_aspect("equal", adjustable="datalim")
    axes.legend(fontsize=8, frameon=False, ncols=4, loc="lower center", bbox_to_anchor=(0.5, 1.0))
    label(axes, "x, mm", "y, mm")


def _error(axes: Axes, run: Walked, mean: float | None) -> None:
    some = extremes(run.error)
    axes.plot(run.time[some], run.error[some], color=GREEN, linewidth=1.0)
    if mean is None and len(run.errors):
        mean = float(run.errors.mean())
    if mean is not None:
        axes.axhline(mean, color=PURPLE, linestyle="--", linewidth=1.0, label=f"mean {mean:.2f} mm")
        axes.legend(fontsize=8, frameon=False)
    axes.set_ylim(bottom=0.0)
    label(axes, "time, s", "error, mm")


def evenly(count: int) -> NDArray[np.int_]:
    """Indices of so many points, or of fewer that are spread evenly over them."""
    return np.linspace(0, max(count - 1, 0), min(count, MOST_DRAWN)).round().astype(int)


def extremes(values: NDArray[np.float64]) -> NDArray[np.int_]:
    """Indices of all values, or of the largest and the smallest of each stretch of them, so that no peak is lost."""
    if len(values) <= MOST_DRAWN:
        return np.arange(len(values))
    stretches = np.array_split(np.arange(len(values)), MOST_DRAWN // 2)
    unknown = np.isnan(values)
    lowest, highest = np.where(unknown, np.inf, values), np.where(unknown, -np.inf, values)
    chosen = [(part[lowest[part].argmin()], part[highest[part].argmax()]) for part in stretches]
    return np.sort(np.array(chosen).ravel())


def _spread(axes: Axes, run: Walked) -> None:
    if len(run.errors):
        axes.hist(
            run.errors, BINS, weights=np.full(len(run.errors), 100.0 / len(run.errors)), color="#9ac4de"
        )
        for share, style in ((50, "-"), (95, ":")):
            value = float(np.percentile(run.errors, share))
            axes.axvline(
                value, color=BLUE, linestyle=style, linewidth=1.0, label=f"{share} % below {value:.2f} mm"
            )
        axes.legend(fontsize=8, frameon=False)
    axes.set_xlim(left=0.0)
    label(axes, "error, mm", "share of the time, %")


def _title(settings: Any, normalized_mean: Any) -> str:
    """What walked, and how well."""
    chosen = [_found(settings, "run", part, "name") for part in ("controller", "trajectory")]
    sweep, tilt = (_found(settings, "run", "gait", name) for name in ("sweep_deg", "tilt_deg"))
    how = [
        " on ".join(str(name) for name in chosen if name),
        f"sweep {sweep:g}°, tilt {tilt:g}°" if _are_numbers(sweep, tilt) else "",
        f"ME {normalized_mean:.4f}" if _are_numbers(normalized_mean) else "",
    ]
    return "   ".join(filter(None, how))


def _found(values: Any, *names: str) -> Any:
    """The value at that place of nested objects, None where there is none."""
    for name in names:
        values = values.get(name) if isinstance(values, dict) else None
    return values


def _are_numbers(*values: Any) -> bool:
    return all(isinstance(value, int | float) and math.isfinite(value) for value in values)
