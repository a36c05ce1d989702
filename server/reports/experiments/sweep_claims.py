"""What section 6 says of the sweep and of the path step, beside the parametric study."""

from __future__ import annotations

import itertools
import math

import numpy as np

from control.studies.analysis.intervals import Interval, mean_of_means, t_quantile
from server.reports.experiments.measured import STEPS, Measured, at_steps, shown
from server.reports.experiments.minimum import RESOLVED, between, near, place_of
from server.reports.experiments.truth import Truth, all_of, below, counted, finding, lies_below
from server.reports.findings import Finding
from server.reports.study.naming import with_interval

TILTS = (20, 25, 30)
BEST_SWEEPS = (30.0, 35.0)
"""The paper's conclusion, deg."""
NOTHING_MORE = Interval(0.0, 0.0, 0.0)
FEWEST = 4
"""Runs for a straight line with an interval."""
SLIP = "on the slip plant, whose table was fitted to sweeps of 15° to 40°"


def of_path_step(found: Measured, ends: Measured) -> list[Finding]:
    """ends: the same study's distance from the reference at the end of the run, mm."""
    places = list(itertools.product(found.levels("sweep"), TILTS))
    grows = [
        below(found.at(sweep=sweep, tilt=tilt, step=low), found.at(sweep=sweep, tilt=tilt, step=high))
        for sweep, tilt in places
        for low, high in itertools.pairwise(STEPS)
    ]
    texts = {
        step: f"ME {with_interval(mean_of_means(found.only(step=step).samples.groups()))}" for step in STEPS
    }
    growths = {(low, high): growth(found, low, high) for low, high in itertools.pairwise(STEPS)}
    more = "; ".join(
        f"{with_interval(one)} more at {high} s than at {low} s" for (low, high), one in growths.items()
    )
    return [
        finding(
            "6, path step", "by increasing the time step, the overall mean error increases",
            f"means over all sets: {at_steps(texts)}; {more}; each step up is dearer in a single set: {counted(grows)}",
            all_of(lies_below(NOTHING_MORE, one) for one in growths.values()), "verdict: by the means over all sets",
        ),
        _falls_short(ends),
    ]  # fmt: skip


def growth(found: Measured, low: float, high: float) -> Interval:
    """How much larger the mean over the sets is at one path step than at another; of sets measured at both."""
    pairs = [
        (one, other)
        for sweep, tilt in itertools.product(found.levels("sweep"), TILTS)
        if len(one := found.at(sweep=sweep, tilt=tilt, step=low))
        and len(other := found.at(sweep=sweep, tilt=tilt, step=high))
    ]
    one, other = (mean_of_means([pair[side] for pair in pairs]) for side in (0, 1))
    value, reach = other.value - one.value, math.hypot(one.half_width, other.half_width)
    return Interval(value, value - reach, value + reach)


def _falls_short(ends: Measured) -> Finding:
    at = {step: {tilt: ends.at(sweep=10, tilt=tilt, step=step) for tilt in TILTS} for step in STEPS}
    truth = all_of(below(at[step][tilt], at[0.3][tilt]) for step in (0.1, 0.2) for tilt in TILTS)
    texts = {step: ", ".join(f"{tilt}°: {shown(at[step][tilt])}" for tilt in TILTS) for step in STEPS}
    paper = (
        "at Δt = 0.3 s the robot ends farther from its start than at the others, at every tilt (sweep 10°)"
    )
    return finding("6, path step", paper, f"mm from the end of the eight, {at_steps(texts)}", truth)


def of_sweep(found: Measured) -> list[Finding]:
    return [
        _falls(found),
        _best_at(found, 30, 35.0),
        _best_at(found, 20, 30.0),
        _conclusion(found),
    ]


def _falls(found: Measured) -> Finding:
    slopes = {step: slope(found.only(tilt=30, step=step)) for step in STEPS}
    truth = all_of(_falling(one) for one in slopes.values())
    texts = {step: f"{with_interval(one)} per 10°" for step, one in slopes.items()}
    paper = "at a tilt of 30°, the error falls as the sweep grows"
    return finding("6, sweep", paper, f"slope of ME over 10° to 40° of sweep, {at_steps(texts)}", truth, SLIP)


def _falling(one: Interval) -> Truth:
    if not one.known:
        return Truth.OPEN
    if one.high < 0.0:
        return Truth.YES
    return Truth.NO if one.low > 0.0 else Truth.OPEN


def slope(found: Measured) -> Interval:
    """Of the metric over the sweep, per 10 degrees: a straight line through all runs."""
    groups = {sweep: found.at(sweep=sweep) for sweep in found.levels("sweep")}
    x = np.concatenate([np.full(len(group), 0.1 * sweep) for sweep, group in groups.items()])
    y = np.concatenate(list(groups.values()))
    if len(x) < FEWEST or float(np.ptp(x)) == 0.0:
        return Interval(math.nan)
    (gradient, offset), freedom = np.polyfit(x, y, 1).tolist(), len(x) - 2
    scatter = float(np.sum((y - offset - gradient * x) ** 2)) / freedom
    reach = t_quantile(freedom) * math.sqrt(scatter / float(np.sum((x - x.mean()) ** 2)))
    return Interval(gradient, gradient - reach, gradient + reach)


def _best_at(found: Measured, tilt: int, sweep: float) -> Finding:
    each = {step: place_of(found.best("sweep", tilt=tilt, step=step)) for step in STEPS}
    whole = place_of(found.best("sweep", tilt=tilt))
    truth = near(found, "sweep", sweep, tilt=tilt)
    texts = {step: "not told" if one is None else with_interval(one, "°") for step, one in each.items()}
    mean = "not told" if whole is None else with_interval(whole, "°")
    paper = f"at a tilt of {tilt}°, the best sweep is about {sweep:.0f}°"
    return finding(
        "6, sweep",
        paper,
        f"mean over the path steps: {mean}; {at_steps(texts)}",
        truth,
        RESOLVED + "; " + SLIP,
    )


def _conclusion(found: Measured) -> Finding:
    low, high = BEST_SWEEPS
    whole = place_of(found.best("sweep"))
    each = {tilt: place_of(found.best("sweep", tilt=tilt)) for tilt in TILTS}
    texts = "; ".join(
        f"tilt {tilt}°: {'not told' if one is None else with_interval(one, '°')}"
        for tilt, one in each.items()
    )
    truth = between(found, "sweep", BEST_SWEEPS)
    mean = "not told" if whole is None else with_interval(whole, "°")
    paper = f"the best sweep is {low:.0f}° to {high:.0f}°"
    return finding(
        "6, sweep", paper, f"mean over tilts and path steps: {mean}; {texts}", truth, RESOLVED + "; " + SLIP
    )
