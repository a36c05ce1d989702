"""What the paper states, what we find, and whether the two may be compared."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from server.reports.locomotion import Locomotion, SweepCost
from server.reports.simulation import GB, GB_BEST, OB, PLANNER, Simulation

MM = 1e-3
SAME_STEPS = 0.10
"""Counts within this share of each other are called reproduced: gain, duration and rate limit are not printed."""
FITTED = "our gain is the one that comes nearest to both of the paper's counts, for it prints none"
OPEN = "the paper prints neither learning rate nor duration nor rate limit; nothing is fitted to this count"
PAPER_STEPS = {(GB, 10): 296, (OB, 10): 269, (GB, 30): 71, (OB, 30): 75}


class Verdict(StrEnum):
    REPRODUCED = "reproduced"
    NOT_REPRODUCED = "not reproduced"
    NOT_COMPARABLE = "not comparable"


@dataclass(frozen=True, slots=True)
class Finding:
    section: str
    paper: str
    ours: str
    verdict: Verdict
    note: str = ""


def _verdict(holds: bool) -> Verdict:
    return Verdict.REPRODUCED if holds else Verdict.NOT_REPRODUCED


def of_locomotion(found: Locomotion) -> list[Finding]:
    """Section 3; the paper prints curves and no numbers."""
    costs = {int(cost.sweep_deg): cost for cost in found.costs}
    widths = {round(path.sweep_deg): path.widest for path in found.paths}
    fewest = min(cost.steps for cost in found.costs)
    same = sum(cost.steps == cost.counted for cost in found.costs)
    turn = max(deg for deg, cost in costs.items() if cost.steps == fewest)
    return [
        Finding(
            "3, paths", "almost a straight line at small sweeps, curved at large ones",
            f"the centre leaves the line by {widths[10] / MM:.2f} mm at 10° and {widths[180] / MM:.2f} mm at 180°",
            _verdict(widths[10] < 0.05 * widths[180]),
        ),
        Finding(
            "3, steps", "very many steps at small sweeps, singular at 0° and 360°",
            f"60 mm take {costs[1].steps} steps at 1°, {costs[30].steps} at 30°, {costs[359].steps} at 359°",
            _verdict(min(costs[1].steps, costs[359].steps) > 20 * fewest),
        ),
        Finding(
            "3, steps", "the number starts to rise after about 200°",
            f"it is smallest ({fewest}) up to {turn}° and rises from there; the closed form is smallest at 180°",
            _verdict(180 <= turn <= 240),
        ),
        Finding(
            "3, travel", "equal to the path at small sweeps, longer and longer at larger ones",
            f"{_ratio(costs[10])} of the path at 10°, {_ratio(costs[90])} at 90°, {_ratio(costs[180])} at 180°",
            _verdict(costs[10].travel < 1.01 * 0.060 < costs[180].travel),
        ),
        Finding(
            "3, count", "Algorithm 1",
            f"the controller's own count equals the closed form at {same} of {len(costs)} sweeps from 1° to 359°",
            Verdict.NOT_COMPARABLE,
            "a check of our own: the paper prints no formula and no numbers",
        ),
    ]  # fmt: skip


def _ratio(cost: SweepCost) -> str:
    return f"{cost.travel / 0.060:.3f}"


def of_simulation(found: Simulation) -> list[Finding]:
    """Section 5."""
    errors = {(r.case.label, r.case.sweep_deg): r.metrics.mean_error for r in found.cases}
    steps = {(r.case.label, r.case.sweep_deg): r.metrics.steps for r in found.cases}
    return [
        *(of_steps(found, label, sweep_deg) for label, sweep_deg in PAPER_STEPS),
        Finding(
            "5, error", "the optimization controller tracks better",
            "; ".join(
                f"at {deg}°: Ob {_mm(errors[OB, deg])}, Gb {_mm(errors[GB, deg])}, "
                f"Gb at its best gain {_mm(errors[GB_BEST, deg])}"
                for deg in (10, 30)
            ),
            _verdict(all(errors[OB, deg] < min(errors[GB, deg], errors[GB_BEST, deg]) for deg in (10, 30))),
        ),
        Finding(
            "5, steps", "“fewer number of steps” for Ob (abstract), yet 75 against 71 at 30°",
            f"{steps[OB, 10]} against {steps[GB, 10]} at 10°, {steps[OB, 30]} against {steps[GB, 30]} at 30°",
            _verdict(steps[OB, 10] < steps[GB, 10] and steps[OB, 30] > steps[GB, 30]),
            "the text contradicts itself; the verdict is on the printed counts: fewer at 10°, more at 30°",
        ),
        Finding(
            "5, error", "“perfectly track the desired trajectory” at the smaller sweep; curves of the error",
            f"mean error at 10°: Gb {_mm(errors[GB, 10])}, Ob {_mm(errors[OB, 10])}",
            Verdict.NOT_COMPARABLE,
            "the paper prints no error in numbers, and neither its gain nor its learning rate",
        ),
        Finding(
            "5, beyond", "–",
            f"planner: {_mm(errors[PLANNER, 10])} at 10°, {_mm(errors[PLANNER, 30])} at 30°, under the same "
            "constraint of the sweep",
            Verdict.NOT_COMPARABLE,
            "ours; the paper has no such controller",
        ),
    ]  # fmt: skip


def of_steps(found: Simulation, label: str, sweep_deg: int) -> Finding:
    """One count of steps beside the paper's."""
    paper, ours = PAPER_STEPS[label, sweep_deg], found.of(label, sweep_deg).metrics.steps
    short = label.split(",")[0]
    return Finding(
        "5, steps",
        f"{short} takes {paper} steps at {sweep_deg}°",
        f"{ours} ({100.0 * (ours - paper) / paper:+.1f} %)",
        _verdict(abs(ours - paper) <= SAME_STEPS * paper),
        f"within {100.0 * SAME_STEPS:.0f} %; {FITTED if label == GB else OPEN}",
    )


def _mm(value: float) -> str:
    return f"{value / MM:.2f} mm"


UNKNOWN_IN_3 = (
    "Algorithm 1 as printed counts passes of its loop as steps, halves the sweep at the wrong pass, tests y_d − y "
    "although the heading 0 walks along x, and tests floating-point numbers for equality. We count pivot switches "
    "and end each sweep exactly at its angle.",
)
UNKNOWN_IN_5 = (
    "Algorithm 2 as printed forgets to reset the heading from which the sweep is counted. We reset it.",
    "The update of the optimization controller is printed with a plus (ascent), its derivatives lack the factor L/2, "
    "and its cost adds m² to rad². We descend, put the factor in, and weight the heading (weight 0 here).",
    "A gradient over one tick of 0.1 s cannot see past the sweep it is committed to. Ours looks ahead by a time that "
    "follows from the sweep.",
    "Gain, learning rate, duration and rate limit of the paper's simulation are not printed. We walk one eight "
    "(125.66 s), with a limit of 2 rad/s; at a gain of 2.5 1/(cm·s) the counts of steps come nearest.",
    "The abstract says that the optimization controller takes fewer steps; the printed counts say so at 10° and the "
    "contrary at 30°.",
)
"""What the paper leaves open in either section, and what we did."""
