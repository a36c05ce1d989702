"""What section 6 says of the tilt, beside the studies over it."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from control.simulation.gait_survey import Spread
from control.simulation.rigid.tilt_study import SEEDS, SWITCHES, TiltPoint
from control.studies.analysis.intervals import Interval, t_quantile
from control.studies.analysis.optimum import Kind, Optimum
from server.reports.drawing import MM
from server.reports.experiments.measured import STEPS, Array, Measured, at_steps, shown
from server.reports.experiments.minimum import RESOLVED, near
from server.reports.experiments.truth import (
    Truth,
    all_of,
    below,
    counted,
    finding,
    lies_below,
    most_of,
)
from server.reports.findings import Finding, Verdict
from server.reports.study.naming import with_interval

SWEEPS = {10: 24.5, 30: 25.0}
"""Sweep, deg -> the best tilt of the paper there, deg: its first figure's dashed line, its second figure's words."""
PAPERS = {
    10: "at a sweep of 10°, ME falls to a minimum around 24.5° of tilt, then rises",
    30: "the minimum is near 25° of tilt in most of the cases (asked here at a sweep of 30°)",
}
SHORTEST_FITTED = 15
"""Sweep, deg; see `control.simulation.plant`."""
LOOKED_AT = (10, 25, 35)
"""Tilts at which a pivot switch is looked at, deg."""
SHOWN_AT = 10
"""Sweep of the paper's first figure of ME, deg."""
NO_EFFECT = 0.02
"""ME that changes by less than this share over all tilts does not depend on the tilt. A choice."""
FEWEST = 3
"""Tilts that tell whether ME depends on them."""
ASSUMED = {
    "slip": "where the minimum lies follows from the assumed robot's slip table (Λ = 3.2): it is no prediction",
    "noslip": "this plant knows neither sticking nor slipping",
    "rigid": "a property of the assumed robot (its Λ); the first 40 s of an eight, at Δt = 0.1 s",
}
SWITCHED = SWITCHES * len(SEEDS)
"""Pivot switches behind each figure of the rigid plant's survey."""
TITLES = {"slip": "slip plant", "noslip": "plant without slip", "rigid": "rigid plant"}


def of_plants(tilts: Measured, rigid: Measured | None) -> list[Finding]:
    """Where over 10-35 degrees ME is smallest, on each plant, at the sweeps of the paper's two figures."""
    plants = {plant: tilts.only(plant=plant) for plant in ("slip", "noslip")}
    if rigid is not None:
        plants["rigid"] = rigid
    return [smallest(plant, measured, sweep) for sweep in SWEEPS for plant, measured in plants.items()]


def smallest(plant: str, measured: Measured, sweep: int) -> Finding:
    texts, truths = {}, []
    for step in _steps(measured):
        fixed: dict[str, object] = {"sweep": sweep} if step is None else {"sweep": sweep, "step": step}
        best = measured.best("tilt", **fixed)
        means = np.array([float(group.mean()) for group in _groups(measured, fixed)])
        truths.append(Truth.NO if _same(means) else near(measured, "tilt", SWEEPS[sweep], **fixed))
        texts[0.1 if step is None else step] = _where(best, means)
    return finding(
        "6, tilt", PAPERS[sweep],
        f"{TITLES[plant]}, 10° to 35°: {at_steps(texts)}", all_of(truths), f"{RESOLVED}; {_note(plant, sweep)}",
    )  # fmt: skip


def _note(plant: str, sweep: int) -> str:
    """Where the slip table is used beyond what it was fitted to, that is said."""
    if plant == "slip" and sweep < SHORTEST_FITTED:
        return f"{ASSUMED[plant]}; it was fitted to sweeps of 15° to 40° only"
    return ASSUMED[plant]


def _steps(measured: Measured) -> tuple[float | None, ...]:
    return STEPS if "gait.path_step_s" in measured.samples.axes else (None,)


def _groups(measured: Measured, fixed: dict[str, object]) -> list[Array]:
    return [group for tilt in measured.levels("tilt") if len(group := measured.at(tilt=tilt, **fixed))]


def _same(means: Array) -> bool:
    """The tilt does nothing."""
    return len(means) >= FEWEST and float(np.ptp(means)) < NO_EFFECT * float(means.min())


def _where(best: Optimum | None, means: Array) -> str:
    if best is None or not len(means):
        return "no run finished"
    change = f"ME {means.min():.3g} to {means.max():.3g}"
    if _same(means):
        return f"no dependence on the tilt ({change})"
    if best.kind is Kind.UNKNOWN:
        return f"smallest at {best.measured:g}°, without an interval ({change})"
    return f"smallest at {with_interval(best.where, '°')}, {best.kind.value} ({change})"


def cause(points: Sequence[TiltPoint]) -> Finding:
    """Why there is a minimum: what a pivot switch of the rigid plant does at a low, a middle and a high tilt."""
    low, middle, high = (
        min(points, key=lambda one: abs(one.tilt - math.radians(tilt))) for tilt in LOOKED_AT
    )
    sticks = _more(low.figures.play, middle.figures.play, SWITCHED, math.degrees(1.0))
    slips = _more(high.figures.displacement, middle.figures.displacement, SWITCHED, 1.0 / MM)
    return finding(
        "6, tilt", "below the minimum the pivots stick, above it they slip",
        f"rigid plant, a straight walk at Λ = {middle.ratio:g}: play of the heading {sticks[0]}° at "
        f"{LOOKED_AT[0]}° of tilt, {sticks[1]}° at {LOOKED_AT[1]}°; slip of a pivot in a sweep {slips[1]} mm at "
        f"{LOOKED_AT[1]}°, {slips[0]} mm at {LOOKED_AT[2]}°",
        all_of((sticks[2], slips[2])), "a property of the assumed robot: the free end lifts where Λ sin α > 1",
    )  # fmt: skip


def by_magnet(points: Sequence[TiltPoint]) -> Finding:
    """Where that minimum lies follows from the magnet: what the switches of weak and of strong ones do."""
    lowest, highest = (math.degrees(end(point.tilt for point in points)) for end in (min, max))
    texts = [
        _of_magnet(ratio, [point for point in points if point.ratio == ratio])
        for ratio in sorted({point.ratio for point in points})
    ]
    return Finding(
        "6, tilt", "–", f"rigid plant, from {lowest:.0f}° to {highest:.0f}° of tilt: {'; '.join(texts)}",
        Verdict.NOT_COMPARABLE,
        "the paper does not print its robot's Λ; where a best tilt lies follows from it and predicts nothing",
    )  # fmt: skip


def _of_magnet(ratio: float, points: Sequence[TiltPoint]) -> str:
    ends = [end(points, key=lambda point: point.tilt).figures for end in (min, max)]
    play = " to ".join(f"{math.degrees(figures.play.mean):.1f}°" for figures in ends)
    slip = " to ".join(f"{figures.displacement.mean / MM:.2f} mm" for figures in ends)
    lifting = math.degrees(math.asin(min(1.0, 1.0 / ratio)))
    return f"at Λ = {ratio:g} the free end lifts from {lifting:.0f}° on, play {play}, slip of a pivot {slip}"


def _more(one: Spread, other: Spread, count: int, scale: float) -> tuple[str, str, Truth]:
    """Both means with their standard errors' intervals, and whether the first is the larger one."""
    first, second = (
        Interval(scale * mean, scale * (mean - reach), scale * (mean + reach))
        for mean, reach in (
            (s.mean, t_quantile(count - 1) * s.deviation / math.sqrt(count)) for s in (one, other)
        )
    )
    return with_interval(first), with_interval(second), lies_below(second, first)


def of_study(found: Measured) -> list[Finding]:
    """The three tilts of the parametric study, at the sweep of the paper's first figure and at all of them."""
    return [_three(found), _dearer(found), _mostly(found)]


def _three(found: Measured) -> Finding:
    truths = [_middle(found, SHOWN_AT, step) for step in STEPS]
    texts = {
        step: ", ".join(
            f"{tilt}°: {shown(found.at(sweep=SHOWN_AT, step=step, tilt=tilt))}" for tilt in (20, 25, 30)
        )
        for step in STEPS
    }
    paper = "at a sweep of 10°, at each path step the minimum is near 25°"
    return finding("6, tilt", paper, f"ME {at_steps(texts)}", all_of(truths), ASSUMED["slip"])


def _middle(found: Measured, sweep: float, step: float) -> Truth:
    """Whether 25 degrees are better than 20 and than 30."""
    low, middle, high = (found.at(sweep=sweep, step=step, tilt=tilt) for tilt in (20, 25, 30))
    return all_of((below(middle, low), below(middle, high)))


def _dearer(found: Measured) -> Finding:
    pairs = {step: [found.at(sweep=SHOWN_AT, step=step, tilt=tilt) for tilt in (20, 30)] for step in STEPS}
    texts = {step: f"{shown(high)} at 30°, {shown(low)} at 20°" for step, (low, high) in pairs.items()}
    truth = all_of(below(low, high) for low, high in pairs.values())
    paper = "slipping costs more than sticking: above 25° the error is larger than below, at each path step"
    return finding("6, tilt", paper, f"ME at a sweep of 10°, {at_steps(texts)}", truth, ASSUMED["slip"])


def _mostly(found: Measured) -> Finding:
    truths = [_middle(found, sweep, step) for sweep in found.levels("sweep") for step in STEPS]
    paper = "over all sweeps, the minimum is near 25° in most of the cases"
    ours = f"25° is better than both 20° and 30°: {counted(truths)} pairs of sweep and path step"
    return finding("6, tilt", paper, ours, most_of(truths), ASSUMED["slip"])
