"""The filter's shortened algebra against filterpy's own."""

import math

import numpy as np
import pytest
from filterpy.kalman import ExtendedKalmanFilter
from numpy.typing import NDArray

from control.model import Pose, wrap
from control.pivot_filter import PivotFilter

NOISE = np.diag([1.6e-9, 1.6e-9, 3.7e-5])


def covariance(random: np.random.Generator) -> NDArray[np.float64]:
    root = random.normal(0.0, 1.0, (3, 3)) * np.array([[1e-4], [1e-4], [1e-2]])
    return root @ root.T + np.diag([1e-10, 1e-10, 1e-6])


def residual(z: NDArray[np.float64], x: NDArray[np.float64]) -> NDArray[np.float64]:
    dx, dy, turn = z - x
    return np.array([dx, dy, wrap(turn)])


@pytest.mark.parametrize("seed", range(20))
def test_a_sighting_is_fused_as_by_filterpys_own_update(seed: int) -> None:
    random = np.random.default_rng(seed)
    state, z = random.normal(0.0, 1.0, (2, 3))
    z[2] += 2.0 * math.pi * (seed % 3)
    ours, theirs = PivotFilter(NOISE), ExtendedKalmanFilter(3, 3)
    ours.x, ours.P = state.copy(), covariance(random)
    theirs.x, theirs.P, theirs.R = state.copy(), ours.P.copy(), NOISE
    distance = ours.innovate(z)
    ours.fuse()
    theirs.update(z, lambda _: np.eye(3), lambda x: x, residual=residual)
    assert distance == pytest.approx(theirs.mahalanobis**2, rel=1e-9)
    assert ours.x == pytest.approx(theirs.x, rel=1e-9)
    assert np.allclose(ours.P, theirs.P, rtol=1e-9, atol=1e-18)


def test_the_covariance_moves_with_the_arc() -> None:
    random = np.random.default_rng(3)
    ours = PivotFilter(NOISE)
    ours.P = before = covariance(random)
    ours.move(Pose(0.1, 0.2, 0.3), (0.004, -0.002), (1e-9, 2e-10, 3e-9, 4e-9, -5e-9, 1e-6))
    noise = np.array([[1e-9, 2e-10, 3e-9], [2e-10, 4e-9, -5e-9], [3e-9, -5e-9, 1e-6]])
    turned = np.array([[1.0, 0.0, 0.002], [0.0, 1.0, 0.004], [0.0, 0.0, 1.0]])
    assert ours.x == pytest.approx([0.1, 0.2, 0.3])
    after = turned @ before @ turned.T + noise
    assert np.allclose(ours.P, after, rtol=1e-12, atol=0.0)


def test_looking_at_a_sighting_changes_neither_state_nor_covariance() -> None:
    ours = PivotFilter(NOISE)
    ours.x, ours.P = np.array([0.1, 0.2, 0.3]), covariance(np.random.default_rng(4))
    before = ours.x.copy(), ours.P.copy()
    ours.innovate((0.5, 0.5, 0.5))
    assert np.array_equal(ours.x, before[0])
    assert np.array_equal(ours.P, before[1])
