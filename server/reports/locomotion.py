"""Section 3 of the paper: straight walking at every sweep angle, in pure kinematics."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from control.controllers import controllers
from control.gait import Gait, detour, steps_for_distance
from control.model import PIVOT_A, PIVOT_B, Pose, pivot_point
from control.simulation.kinematic import KinematicWalker
from control.trajectories import trajectories

LENGTH = 0.010
PATH_DISTANCE = 0.040
"""Of the paper's figure of paths, m."""
STEP_DISTANCE = 0.060
"""Of the paper's figure of steps, m."""
PATH_SWEEPS_DEG = (1, 10, 30, 90, 180, 300)
SWEEPS_DEG = tuple(range(1, 360))
RATE_DEG_S = 100.0
FINE_TURN = math.radians(2.0)
"""Between two points of a drawn path, rad."""


@dataclass(frozen=True, slots=True)
class StraightPath:
    """One straight walk. centre, a, b: (n, 2) positions of the centre and of both ends, m."""

    sweep_deg: float
    steps: int
    centre: NDArray[np.float64]
    a: NDArray[np.float64]
    b: NDArray[np.float64]

    @property
    def widest(self) -> float:
        """Largest distance of the centre from the straight line, m."""
        return float(np.abs(self.centre[:, 1]).max())


@dataclass(frozen=True, slots=True)
class SweepCost:
    """What a sweep angle costs over STEP_DISTANCE. counted, travelled: by the controller in kinematics.

    steps, travel: the closed forms.  travelled, travel: way of the centre, m.
    """

    sweep_deg: float
    steps: int
    counted: int
    travel: float
    travelled: float


@dataclass(frozen=True, slots=True)
class Locomotion:
    paths: tuple[StraightPath, ...]
    costs: tuple[SweepCost, ...]


def analyse() -> Locomotion:
    """All that the three figures of section 3 show."""
    paths = tuple(straight_path(math.radians(deg), PATH_DISTANCE) for deg in PATH_SWEEPS_DEG)
    return Locomotion(paths, tuple(cost(deg) for deg in SWEEPS_DEG))


def straight_path(sweep: float, distance: float) -> StraightPath:
    """Algorithm 1 with the paper's robot along the x axis."""
    walker = _walker(sweep, distance)
    poses = [walker.pose]
    while not walker.is_finished:
        walker.advance(0.0, min(FINE_TURN, sweep / 4.0) / math.radians(RATE_DEG_S))
        poses.append(walker.pose)
    return StraightPath(
        sweep_deg=math.degrees(sweep),
        steps=walker.sweep.counts.steps,
        centre=np.array([(pose.x, pose.y) for pose in poses]),
        a=np.array([pivot_point(pose, PIVOT_A, LENGTH) for pose in poses]),
        b=np.array([pivot_point(pose, PIVOT_B, LENGTH) for pose in poses]),
    )


def cost(sweep_deg: float) -> SweepCost:
    """The closed forms beside the controller's own count, for one sweep angle."""
    sweep = math.radians(sweep_deg)
    walker = _walker(sweep, STEP_DISTANCE)
    while not walker.is_finished:
        walker.advance(0.0, 1000.0)
    counts = walker.sweep.counts
    return SweepCost(
        sweep_deg=sweep_deg,
        steps=steps_for_distance(STEP_DISTANCE, sweep, LENGTH),
        counted=counts.steps,
        travel=STEP_DISTANCE * detour(sweep),
        travelled=0.5 * LENGTH * sweep * (counts.sweeps - 0.5),
    )


def _walker(sweep: float, distance: float) -> KinematicWalker:
    straight = controllers.build("straight", {"distance_mm": distance * 1e3, "rate_deg_s": RATE_DEG_S})
    gait = Gait(sweep=sweep, max_rate=math.radians(RATE_DEG_S))
    return KinematicWalker(straight, trajectories.build("line", {}), gait, Pose(0.0, 0.0, 0.0), LENGTH)
