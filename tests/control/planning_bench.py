"""What the tests of the gradient controller and the planner share: the paper's set-up, and places to hold."""

import math
from collections.abc import Mapping
from typing import Any

from control.controllers import controllers
from control.gait import Gait
from control.metrics import Metrics
from control.model import Pose
from control.simulation.kinematic import KinematicWalker, walk
from control.simulation.trade_off import PAPER_LENGTH, PAPER_START
from control.trajectories import trajectories
from control.trajectories.eight import PAPER_PERIOD
from control.trajectories.trajectory import Path

GAINS = (1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0, 7.0, 8.0, 10.0)


class Still:
    """A desired point that does not move."""

    duration = 10.0
    closed = False

    def __init__(self, x: float, y: float) -> None:
        self._point = x, y

    def point(self, time: float) -> tuple[float, float]:  # noqa: ARG002 (the path's signature)
        return self._point


def walker(
    name: str, sweep: float, parameters: Mapping[str, Any], path: Path, start: Pose = PAPER_START
) -> KinematicWalker:
    gait = Gait(sweep=math.radians(sweep))
    return KinematicWalker(controllers.build(name, parameters), path, gait, start, PAPER_LENGTH)


def one_eight(name: str, sweep: float, **parameters: object) -> Metrics:
    """The paper's walk. sweep: degrees."""
    return walk(walker(name, sweep, parameters, trajectories.build("eight", {})), PAPER_PERIOD).metrics


def best_geometric(sweep: float) -> float:
    """The geometric controller's mean error at its best gain for a sweep (degrees), m."""
    return min(one_eight("geometric", sweep, gain=gain).mean_error for gain in GAINS)
