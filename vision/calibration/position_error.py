"""How far off positions on the plate are, by what is known of the points that the plane was fitted to.

Not the residual of these points: that is the noise of one point, of which a fit to many averages most away. What
is left are three things, which do not depend on each other: the noise that reached the pose (its covariance, carried
to positions by the Jacobian), the lens's own uncertainty, and a smooth misfit that neither of the two explains (a
lens that was assumed, a bent sheet).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from vision.calibration.lens import POSE, Lens

Floats = NDArray[np.float64]

ACROSS = 9
"""The workspace is sampled at so many places along each side."""
DEGREE = 3
"""Degree of the polynomials that a smooth misfit is sought with: what a lens's distortion looks like."""
SURELY = 3.0
"""A misfit counts when it is this many standard deviations above what noise alone would show."""


@dataclass(frozen=True, slots=True)
class PoseFit:
    """A camera's pose over known points.

    turn, shift: rotation vector and translation (m), workspace to camera.  points: (n, 3) m.
    residuals: (n, 2) seen less fitted, px.  noise: standard deviation of one coordinate of one point, px.
    """

    lens: Lens
    turn: Floats
    shift: Floats
    points: Floats
    residuals: Floats
    noise: float


def position_error(fit: PoseFit, workspace: float) -> float:
    """RMS error of positions over the workspace (a square of this half side, m), m."""
    to_plate, jacobian = _at_workspace(fit, workspace)
    _, at_points = fit.lens.project(fit.points, fit.turn, fit.shift)
    pose = at_points[:, POSE]
    spread = fit.noise**2 * np.linalg.pinv(pose.T @ pose, hermitian=True)
    moved = np.einsum("nij,njk->nik", to_plate, jacobian)
    by_pose = float(np.einsum("nij,jk,nik->n", moved, spread, moved).mean())
    by_picture = float(np.mean(np.sum(to_plate**2, axis=(1, 2)))) / 2.0
    """m^2 on the plate for a px^2 in the picture, of a shift in any direction."""
    return math.sqrt(by_pose + by_picture * (fit.lens.error**2 + misfit(fit) ** 2))


def _at_workspace(fit: PoseFit, workspace: float) -> tuple[Floats, Floats]:
    """For places of the workspace: (n, 2, 2) plate (m) by picture (px), and (n, 2, 6) picture (px) by pose."""
    steps = np.linspace(-workspace, workspace, ACROSS)
    x, y = (grid.ravel() for grid in np.meshgrid(steps, steps))
    places = np.column_stack([x, y, np.zeros(len(x))])
    _, jacobian = fit.lens.project(places, fit.turn, fit.shift)
    by_pose = jacobian[:, POSE].reshape(-1, 2, 6)
    axes, _ = cv2.Rodrigues(fit.turn)
    by_place = by_pose[:, :, 3:] @ axes[:, :2]
    return np.linalg.inv(by_place).astype(float), by_pose


def misfit(fit: PoseFit) -> float:
    """RMS, px, of the smooth part of the residuals that is more than noise; 0 where noise explains it."""
    basis = _smooth(fit)
    points = len(fit.points)
    if basis is None:
        return 0.0
    smooth = basis.T @ fit.residuals.T.ravel()
    rough = float(np.sum(fit.residuals**2)) - float(smooth @ smooth)
    noise = rough / (2 * points - basis.shape[1] - 6)
    excess = float(smooth @ smooth) - basis.shape[1] * noise
    if not excess > SURELY * math.sqrt(2.0 * basis.shape[1]) * noise:
        return 0.0
    return math.sqrt(excess / points)


def _smooth(fit: PoseFit) -> Floats | None:
    """Orthonormal columns (2n, m): polynomials over the points, u then v, less what a pose explains.

    None where there are too few points to tell smooth from rough.
    """
    x, y = (fit.points[:, :2] / np.abs(fit.points[:, :2]).max()).T
    powers = [x**i * y**j for i in range(DEGREE + 1) for j in range(DEGREE + 1 - i)]
    if len(x) < 2 * len(powers):
        return None
    one = np.column_stack(powers)
    both = np.block([[one, np.zeros_like(one)], [np.zeros_like(one), one]])
    _, jacobian = fit.lens.project(fit.points, fit.turn, fit.shift)
    pose, _ = np.linalg.qr(np.vstack([jacobian[0::2, POSE], jacobian[1::2, POSE]]))
    left, sizes, _ = np.linalg.svd(both - pose @ (pose.T @ both), full_matrices=False)
    return left[:, sizes > 1e-6 * sizes[0]]
