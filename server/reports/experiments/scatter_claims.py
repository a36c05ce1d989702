"""What section 6 says of how single runs scatter, and of its two controllers, beside a hundred runs of each set."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from control.studies.analysis.distribution import REFUSED, Distribution, describe
from control.studies.analysis.intervals import Interval
from server.reports.experiments.measured import Measured
from server.reports.experiments.truth import Truth, all_of, below, finding, lies_below, most_of, of
from server.reports.findings import Finding, Verdict
from server.reports.study.naming import chance_text, number, with_interval
from server.reports.study.printed import PRINTED, UNIT_NOTE

SETS = ((25, 25), (30, 25), (30, 30))
"""Sweep and tilt of the paper's three sets, deg."""
GB, OB, PLANNER = "geometric", "gradient", "planner"
LABELS = {GB: "Gb", OB: "Ob", PLANNER: "planner"}
PAPERS = (GB, OB)
CLEARLY = 4.0
"""A law whose Akaike criterion is larger by this much fits clearly worse."""
HISTOGRAM = 100
"""Runs in a histogram of the paper."""
CLOSE = 0.5 * 3.49 * HISTOGRAM ** (-1.0 / 3.0)
"""How exactly such a histogram shows its peak, in deviations: half a bin of Scott's rule."""
SHAPES = 101
"""Looked at in an interval of the shape."""
PLANT = "on the slip plant, whose scatter is assumed"


@dataclass(frozen=True, slots=True)
class Scatter:
    """errors, steps: of every run.  laws: (controller, sweep, tilt) -> how its runs scatter."""

    errors: Measured
    steps: Measured
    laws: Mapping[tuple[str, int, int], Distribution]


def scatter_of(errors: Measured, steps: Measured) -> Scatter:
    laws = {
        (controller, sweep, tilt): describe(errors.at(controller=controller, sweep=sweep, tilt=tilt))
        for sweep, tilt in SETS
        for controller in (GB, OB, PLANNER)
    }
    return Scatter(errors, steps, laws)


def of_scatter(found: Scatter) -> list[Finding]:
    return [
        _weibull(found),
        _peak(found),
        _higher_tilt(found),
        _wider(found),
        _higher_sweep(found),
        _better(found),
        _steps(found),
        *_printed(found),
        _planner(found),
    ]


def _of_papers(found: Scatter) -> dict[tuple[str, int, int], Distribution]:
    return {key: law for key, law in found.laws.items() if key[0] in PAPERS}


def named(key: tuple[str, int, int]) -> str:
    controller, sweep, tilt = key
    return f"{LABELS[controller]} {{{sweep},{tilt}}}"


def _weibull(found: Scatter) -> Finding:
    laws = _of_papers(found)
    texts = [
        f"{named(key)}: shape {with_interval(law.weibull.shape)}, scale {with_interval(law.weibull.scale)}, "
        f"p {chance_text(law.weibull.p_anderson)}"
        for key, law in laws.items()
        if law.weibull is not None
    ]
    refused = REFUSED / len(laws)
    truths = [is_weibull(law, refused) for law in laws.values()]
    closest = [min(law.preference, key=law.preference.__getitem__) for law in laws.values() if law.preference]
    others = (
        f"; the best of Weibull, shifted Weibull, normal and log-normal: {', '.join(closest)}"
        if closest
        else ""
    )
    return finding(
        "6, scatter", "the errors of 100 runs have a semi-bell shape, “more Weibull”",
        f"{'; '.join(texts) or 'too few runs'}{others}", all_of(truths),
        f"verdict: yes where a Weibull law (from 0 or shifted) fits clearly better than normal and log-normal, by "
        f"Akaike's criterion; no where both are refused (Anderson-Darling, p < {REFUSED} over all six, each below "
        f"{refused:.2g}) or fit clearly worse; {PLANT}",
    )  # fmt: skip


def is_weibull(law: Distribution, refused: float) -> Truth:
    """Not to be refused is not enough: few runs refuse nothing. refused: the p below which a law is."""
    if law.weibull is None or law.located is None:
        return Truth.OPEN
    if max(law.weibull.p_anderson, law.located.p_anderson) < refused:
        return Truth.NO
    ours = min(value for name, value in law.preference.items() if name.startswith("Weibull"))
    others = min(value for name, value in law.preference.items() if not name.startswith("Weibull"))
    if ours - others > CLEARLY:
        return Truth.NO
    return Truth.YES if others - ours > CLEARLY else Truth.OPEN


def _peak(found: Scatter) -> Finding:
    texts, truths = [], []
    for key, law in _of_papers(found).items():
        if law.weibull is None:
            truths.append(Truth.OPEN)
            continue
        mode = mode_of(law.weibull.law.shape, law.weibull.law.scale)
        texts.append(f"{named(key)}: peak {number(mode)}, mean {number(law.mean.value)}")
        truths.append(peaks_at_mean(law.weibull.shape))
    note = (
        "peak of the fitted Weibull law, for all shapes of its interval within half a bin of a histogram of "
        f"{HISTOGRAM} runs ({CLOSE:.2g} deviations) of the mean; {PLANT}"
    )
    paper = "the peak of the curve corresponds to ME"
    return finding("6, scatter", paper, "; ".join(texts) or "too few runs", all_of(truths), note)


def peaks_at_mean(shape: Interval) -> Truth:
    """Whether peak and mean of a Weibull law are close, by the interval of its shape; the scale does not matter."""
    if not shape.known:
        return Truth.OPEN
    near = {abs(peak_off_mean(one)) <= CLOSE for one in np.linspace(shape.low, shape.high, SHAPES)}
    return of(near.pop()) if len(near) == 1 else Truth.OPEN


def peak_off_mean(shape: float) -> float:
    """How far the peak of a Weibull law lies above its mean, in deviations."""
    mean, square = math.gamma(1.0 + 1.0 / shape), math.gamma(1.0 + 2.0 / shape)
    return (mode_of(shape, 1.0) - mean) / math.sqrt(square - mean * mean)


def mode_of(shape: float, scale: float) -> float:
    """Where a Weibull law from 0 is densest."""
    return scale * ((shape - 1.0) / shape) ** (1.0 / shape) if shape > 1.0 else 0.0


def _compared(found: Scatter, one: tuple[int, int], other: tuple[int, int]) -> tuple[str, Truth]:
    """The means of two sets for both of the paper's controllers, and whether the first lie below the second."""
    texts, truths = [], []
    for controller in PAPERS:
        low, high = (found.laws[controller, *place] for place in (one, other))
        texts.append(
            f"{LABELS[controller]}: {with_interval(low.mean)} at {{{one[0]},{one[1]}}}, "
            f"{with_interval(high.mean)} at {{{other[0]},{other[1]}}}"
        )
        truths.append(below(low.values, high.values))
    return "; ".join(texts), all_of(truths)


def _higher_tilt(found: Scatter) -> Finding:
    text, truth = _compared(found, (30, 25), (30, 30))
    return finding("6, scatter", "a larger tilt (25° to 30°) moves the mean up", f"ME {text}", truth, PLANT)


def _higher_sweep(found: Scatter) -> Finding:
    text, truth = _compared(found, (30, 25), (25, 25))
    return finding(
        "6, scatter", "a larger sweep (25° to 30°) gives a smaller mean", f"ME {text}", truth, PLANT
    )


def _wider(found: Scatter) -> Finding:
    widths = {c: [found.laws[c, *place].deviation for place in ((30, 25), (30, 30))] for c in PAPERS}
    texts = "; ".join(
        f"{LABELS[c]}: {with_interval(low)} at 25°, {with_interval(high)} at 30°"
        for c, (low, high) in widths.items()
    )
    return finding(
        "6, scatter", "a larger tilt (25° to 30°) gives a wider distribution with a lower peak",
        f"deviation of ME, {texts}", all_of(lies_below(low, high) for low, high in widths.values()),
        f"the paper's own table says the contrary: 9.92 at 25° and 3.47 at 30° for Gb; {PLANT}",
    )  # fmt: skip


def _better(found: Scatter) -> Finding:
    pairs = {place: [found.laws[c, *place] for c in PAPERS] for place in SETS}
    texts = "; ".join(
        f"{{{sweep},{tilt}}}: Ob {with_interval(ob.mean)}, Gb {with_interval(gb.mean)}"
        for (sweep, tilt), (gb, ob) in pairs.items()
    )
    truth = all_of(below(ob.values, gb.values) for gb, ob in pairs.values())
    note = f"gains are not printed: Gb at its default gain 3 1/(cm·s), Ob as built here; {PLANT}"
    return finding("6, controllers", "Ob has the smaller mean error in each set", f"ME {texts}", truth, note)


def _steps(found: Scatter) -> Finding:
    at = {
        place: [found.steps.at(controller=c, sweep=place[0], tilt=place[1]) for c in PAPERS] for place in SETS
    }
    texts = "; ".join(
        f"{{{sweep},{tilt}}}: Ob {ob.mean():.0f}, Gb {gb.mean():.0f}"
        for (sweep, tilt), (gb, ob) in at.items()
        if len(gb) and len(ob)
    )
    fewer = most_of([below(ob, gb) for gb, ob in at.values()])
    saying = {Truth.YES: "here it takes fewer", Truth.NO: "here it does not take fewer", Truth.OPEN: "open"}[
        fewer
    ]
    return Finding(
        "7, controllers", "Ob takes a higher number of steps (conclusion); fewer (abstract)",
        f"mean steps in an eight, {texts or 'no run finished'}; {saying}", Verdict.NOT_COMPARABLE,
        "the paper says both",
    )  # fmt: skip


def _printed(found: Scatter) -> list[Finding]:
    """The table of variances and standard deviations."""
    wrong = [row for row in PRINTED if not row.consistent]
    rows = "; ".join(
        f"{row.label} {{{row.sweep_deg},{row.tilt_deg}}}: {row.variance:g} is not {row.deviation:g}² = "
        f"{row.deviation**2:.2f}"
        for row in wrong
    )
    return [
        Finding(
            "6, table", "variances and standard deviations of six sets",
            f"{len(wrong)} of the {len(PRINTED)} printed rows contradict themselves: {rows}", Verdict.NOT_COMPARABLE,
            UNIT_NOTE,
        ),
        _order(found),
        _same_width(found),
    ]  # fmt: skip


def _widths(found: Scatter, controller: str) -> dict[tuple[int, int], Interval]:
    return {place: found.laws[controller, *place].deviation for place in SETS}


def _order(found: Scatter) -> Finding:
    """The paper's deviations: {30,25} > {25,25} > {30,30}, for both controllers."""
    truths, texts = [], []
    for controller in PAPERS:
        width = _widths(found, controller)
        truths += [lies_below(width[30, 30], width[25, 25]), lies_below(width[25, 25], width[30, 25])]
        each = ", ".join(f"{{{s},{t}}} {with_interval(one)}" for (s, t), one in width.items())
        texts.append(f"{LABELS[controller]}: {each}")
    paper = "the deviation is largest at {30,25}, then {25,25}, smallest at {30,30}, for both controllers"
    return finding("6, table", paper, f"deviation of ME, {'; '.join(texts)}", all_of(truths), PLANT)


def _same_width(found: Scatter) -> Finding:
    """The paper's deviations of Gb and Ob differ by 0.1, 0.4 and 10 %."""
    pairs = {place: [found.laws[c, *place].deviation for c in PAPERS] for place in SETS}
    narrower = [lies_below(ob, gb) for gb, ob in pairs.values()]
    wider = [lies_below(gb, ob) for gb, ob in pairs.values()]
    truth = Truth.NO if Truth.YES in (*narrower, *wider) else Truth.OPEN
    texts = "; ".join(
        f"{{{s},{t}}}: Ob {with_interval(ob)}, Gb {with_interval(gb)}" for (s, t), (gb, ob) in pairs.items()
    )
    paper = "Ob scatters as much as Gb: their deviations differ by 0.1 %, 0.4 % and 10 %"
    note = f"two of the printed deviations contradict their variances; by these, 7 %, 0.4 % and 2 %; {PLANT}"
    return finding("6, table", paper, f"deviation of ME, {texts}", truth, note)


def _planner(found: Scatter) -> Finding:
    texts = "; ".join(
        f"{{{sweep},{tilt}}}: {with_interval(found.laws[PLANNER, sweep, tilt].mean)}" for sweep, tilt in SETS
    )
    truth = all_of(
        below(found.laws[PLANNER, *place].values, found.laws[other, *place].values)
        for place in SETS
        for other in PAPERS
    )
    saying = {
        Truth.YES: "below Gb and Ob in each set",
        Truth.NO: "not below both in each set",
        Truth.OPEN: "whether below both is not told",
    }[truth]
    return Finding(
        "6, beyond", "–", f"planner, ME {texts}: {saying}", Verdict.NOT_COMPARABLE,
        "ours; the paper has no such controller",
    )  # fmt: skip
