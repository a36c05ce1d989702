"""The controllers on the simulated rig with slip, through pixels and bytes: paired walks, seed by seed."""

import math
from collections.abc import Sequence
from itertools import product

import numpy as np
import pytest
from scipy import stats

from control.gait import Gait
from control.runs import Choice, RunRequest, Selection
from server.assembly import build_machine
from server.headless import run_headless
from server.settings import RigFile

GAIT = Gait(sweep=math.radians(30.0), tilt=math.radians(24.5), approach=True)
PATHS = ("eight", "circle", "line", "lissajous", "spiral")
CONFIDENCE = 0.975
"""Of each end of a 95 % interval."""


def mean_error(controller: str, path: str, seed: int, duration: float) -> float:
    """Of one walk on the slip plant, by the estimate, m."""
    machine = build_machine(RigFile().with_simulation(plant="slip", seed=seed), realtime=False)
    selection = Selection(Choice(controller), Choice(path), GAIT)
    done = run_headless(machine, "a walk", RunRequest(selection, duration=duration))
    return done.ended.metrics.mean_error


def interval(values: np.ndarray) -> tuple[float, float]:
    """95 % interval of the mean."""
    half = stats.t.ppf(CONFIDENCE, len(values) - 1) * stats.sem(values)
    return float(values.mean() - half), float(values.mean() + half)


def errors_of(controller: str, walks: Sequence[tuple[str, int]], duration: float) -> np.ndarray:
    return np.array([mean_error(controller, path, seed, duration) for path, seed in walks])


@pytest.mark.timeout(3600)
def test_the_planner_is_three_times_as_accurate_as_geometric_with_gradient_between(full: bool) -> None:
    walks, duration = (
        (list(product(PATHS, range(1, 11))), 60.0) if full else ([("eight", 1), ("circle", 1)], 40.0)
    )
    geometric, gradient, planner = (
        errors_of(controller, walks, duration) for controller in ("geometric", "gradient", "planner")
    )
    assert planner.mean() <= geometric.mean() / 3.0
    assert gradient.mean() < geometric.mean()
    if full:
        assert interval(planner)[1] < interval(geometric)[0] / 3.0
        assert interval(gradient)[1] < interval(geometric)[0]
