"""Error over sweeps: what the planner's accuracy costs, in the paper's set-up, to choose its weights by."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from control.controllers import controllers
from control.gait import Gait
from control.model import Pose
from control.simulation.kinematic import KinematicWalker, walk
from control.trajectories import trajectories
from control.trajectories.eight import PAPER_PERIOD

PAPER_START = Pose(0.0, -0.042, 0.5 * math.pi)
PAPER_LENGTH = 0.010
SWITCH_WEIGHTS = (0.0, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0)
"""mm^2 s."""


@dataclass(frozen=True, slots=True)
class Trade:
    """One eight. switch_weight: mm^2 s.  mean_error: m.  The rest are counts."""

    switch_weight: float
    mean_error: float
    switches: int
    sweeps: int
    reversals: int


def error_over_sweeps(
    sweep: float, weights: Iterable[float] = SWITCH_WEIGHTS, early_end: bool = False
) -> list[Trade]:
    """One eight in pure kinematics for each weight of a pivot switch. sweep: rad."""
    return [_trade(sweep, weight, early_end) for weight in weights]


def _trade(sweep: float, weight: float, early_end: bool) -> Trade:
    planner = controllers.build("planner", {"switch_weight": weight, "early_end": early_end})
    eight = trajectories.build("eight", {})
    walker = KinematicWalker(planner, eight, Gait(sweep=sweep), PAPER_START, PAPER_LENGTH)
    metrics = walk(walker, PAPER_PERIOD).metrics
    return Trade(weight, metrics.mean_error, metrics.steps, metrics.sweeps, metrics.reversals)
