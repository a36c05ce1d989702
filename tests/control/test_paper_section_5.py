"""The paper's simulation in pure kinematics, as far as it can be recovered."""

import math

import pytest

from control.controllers import controllers
from control.gait import Gait
from control.metrics import Metrics
from control.model import Pose
from control.simulation.kinematic import KinematicWalker, walk
from control.trajectories import trajectories

LENGTH = 0.010
START = Pose(0.0, -0.042, math.pi / 2)


def one_eight(sweep_deg: float, gain: float = 2.5) -> Metrics:
    walker = KinematicWalker(
        controllers.build("geometric", {"gain": gain}),
        trajectories.build("eight", {}),
        Gait(sweep=math.radians(sweep_deg)),
        START,
        LENGTH,
    )
    return walk(walker, 125.66).metrics


@pytest.mark.parametrize(("sweep_deg", "paper_steps"), [(10, 296), (30, 71)])
def test_geometric_takes_the_papers_number_of_steps(sweep_deg: float, paper_steps: int) -> None:
    assert one_eight(sweep_deg).steps == pytest.approx(paper_steps, rel=0.08)


@pytest.mark.parametrize(
    ("sweep_deg", "steps", "sweeps", "error_mm"), [(10, 290, 437, 2.45), (30, 75, 167, 2.80)]
)
def test_geometric_repeats_the_prototype(sweep_deg: float, steps: int, sweeps: int, error_mm: float) -> None:
    metrics = one_eight(sweep_deg)
    assert (metrics.steps, metrics.sweeps) == (steps, sweeps)
    assert metrics.mean_error * 1e3 == pytest.approx(error_mm, abs=0.01)


def test_the_eight_is_377_mm_long() -> None:
    from control.trajectories.trajectory import length_of

    assert length_of(trajectories.build("eight", {})) * 1e3 == pytest.approx(377.16, abs=0.05)
