"""Section 5 of the paper: one eight in pure kinematics, with the paper's controllers and ours."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from control.controllers import controllers
from control.gait import Gait
from control.metrics import Metrics
from control.model import Pose
from control.simulation.kinematic import TICK, KinematicWalker, Walk, walk
from control.trajectories import trajectories

LENGTH = 0.010
START = Pose(0.0, -0.042, math.pi / 2.0)
ONE_EIGHT = 125.66
"""Duration of one pass of the paper's eight, s; the paper does not give its own."""
SWEEPS_DEG = (10, 30)
PAPER_GAIN = 2.5
"""1/(cm s); not printed in the paper: the gain at which our count of steps comes nearest to both of the paper's."""
GAINS = tuple(0.5 * number for number in range(2, 25))
SWEEP_WEIGHTS = (0.0, 0.03, 0.1, 0.3, 1.0, 3.0)
EARLY_WEIGHTS = (0.0, 0.01, 0.03, 0.1, 0.3)
"""Of the planner, mm^2 s, its default first: what one sweep may cost, for the curve of error over
sweeps; the second ones where it may end a sweep early."""


@dataclass(frozen=True, slots=True)
class Case:
    """One walk to make. label: for people.  parameters: in the units of the controller's parameter model."""

    label: str
    controller: str
    sweep_deg: int
    parameters: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Result:
    case: Case
    walk: Walk

    @property
    def metrics(self) -> Metrics:
        return self.walk.metrics

    @property
    def centre(self) -> NDArray[np.float64]:
        """(n, 2) positions of the centre, once a tick, m."""
        return np.array([(pose.x, pose.y) for pose in self.walk.poses])

    @property
    def error(self) -> NDArray[np.float64]:
        """(n,) distance from the reference, once a tick, m."""
        return np.hypot(*(self.centre - reference(len(self.walk.poses))).T)


@dataclass(frozen=True, slots=True)
class Simulation:
    """cases: the table.  gains: Gb at every gain.  choices, early: the planner at every cost of a sweep, and
    where it may end a sweep early."""

    cases: tuple[Result, ...]
    gains: tuple[Result, ...]
    choices: tuple[Result, ...]
    early: tuple[Result, ...]

    def of(self, label: str, sweep_deg: int) -> Result:
        return next(r for r in self.cases if r.case.label == label and r.case.sweep_deg == sweep_deg)


GB, GB_BEST, OB = "Gb, gain 2.5", "Gb, best gain", "Ob"
PLANNER, PLANNER_EARLY = "planner", "planner, early ends"


def simulate() -> Simulation:
    """Every case at both of the paper's sweep angles."""
    cases, gains, choices, early = [], [], [], []
    for sweep_deg in SWEEPS_DEG:
        at_gains = [run(_gb(gain, sweep_deg)) for gain in GAINS]
        best = min(at_gains, key=lambda result: result.metrics.mean_error)
        gains += at_gains
        planned = [run(_planner(weight, sweep_deg)) for weight in SWEEP_WEIGHTS]
        ended = [run(_planner(weight, sweep_deg, early_end=True)) for weight in EARLY_WEIGHTS]
        choices += planned
        early += ended
        cases += [
            run(Case(GB, "geometric", sweep_deg, {"gain": PAPER_GAIN})),
            _as(best, Case(GB_BEST, "geometric", sweep_deg, best.case.parameters)),
            run(Case(OB, "gradient", sweep_deg)),
            _as(planned[0], Case(PLANNER, "planner", sweep_deg)),
            _as(ended[0], Case(PLANNER_EARLY, "planner", sweep_deg, {"early_end": True})),
        ]
    return Simulation(tuple(cases), tuple(gains), tuple(choices), tuple(early))


def _as(result: Result, case: Case) -> Result:
    """The same walk under another label."""
    return Result(case, result.walk)


def _gb(gain: float, sweep_deg: int) -> Case:
    return Case(f"Gb, gain {gain:g}", "geometric", sweep_deg, {"gain": gain})


def _planner(weight: float, sweep_deg: int, early_end: bool = False) -> Case:
    parameters = {"sweep_weight": weight, "early_end": early_end}
    return Case(f"planner, sweep weight {weight:g}", "planner", sweep_deg, parameters)


def run(case: Case) -> Result:
    """One eight from the paper's start, at its tick."""
    controller = controllers.build(case.controller, case.parameters)
    gait = Gait(sweep=math.radians(case.sweep_deg))
    walker = KinematicWalker(controller, trajectories.build("eight", {}), gait, START, LENGTH)
    return Result(case, walk(walker, ONE_EIGHT))


def reference(count: int) -> NDArray[np.float64]:
    """(count, 2) desired points, once a tick, m."""
    eight = trajectories.build("eight", {})
    return np.array([eight.point(index * TICK) for index in range(count)])
