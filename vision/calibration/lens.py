"""The lens from views of the printed board: pinhole and Brown-Conrady distortion, and how well they are known.

Z. Zhang, "A flexible new technique for camera calibration" (2000), as OpenCV has it, with the model k1 k2 p1 p2 k3.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from vision.calibration.board import Sighting
from vision.camera_model import CalibrationError, CameraModel

Floats = NDArray[np.float64]

FEWEST_VIEWS = 6
"""A pinhole with distortion has 9 unknowns and each view 6 more; each view of a plane brings at most 8 equations
that are worth something, so that 6 views leave a margin."""
OUTLYING = 3.0
"""A view whose residual is so many times the median of all is not believed: the board moved, or was bent."""
POOREST_RESIDUAL = 1.5
"""A larger residual than this, px, is no calibration: a bent board, a wrong square size, or a moving board."""
POOREST_ERROR = 1.0
"""So far off may the lens leave a place in the picture, px; beyond, the views do not fix it."""
POOREST_FOCAL = 0.02
"""Share by which the focal length may be unknown. It says how far away the plate is, and so how far a raised robot
looks shifted: at 60 mm from the middle, 3 mm above a plate 350 mm away, 2 % are 0.01 mm."""
POSE = slice(0, 6)
LENS = slice(6, 15)
"""Columns of OpenCV's Jacobian: rotation and translation; then fx, fy, cx, cy, k1, k2, p1, p2, k3."""
MIDDLE = 0.92
"""The workspace takes this share of the picture's shorter side (120 of 130 mm in the paper's rig)."""
ACROSS = 13
"""The middle of the picture is sampled at so many places along each side."""


@dataclass(frozen=True, slots=True)
class Lens:
    """size: of the picture it holds for, px.  fx, fy, cx, cy: pinhole, px.  distortion: k1, k2, p1, p2, k3.

    error: how far off, RMS, it leaves a place in the middle of the picture after a plane has been fitted, px;
    0 for a lens that is taken for granted.
    """

    size: tuple[int, int]
    fx: float
    fy: float
    cx: float
    cy: float
    distortion: tuple[float, float, float, float, float]
    error: float = 0.0

    @classmethod
    def of(cls, model: CameraModel) -> Lens:
        """The lens of a camera model."""
        return cls(model.size, model.fx, model.fy, model.cx, model.cy, model.distortion)

    @property
    def matrix(self) -> Floats:
        """(3, 3) pinhole, px."""
        return np.array([[self.fx, 0.0, self.cx], [0.0, self.fy, self.cy], [0.0, 0.0, 1.0]])

    @property
    def coefficients(self) -> Floats:
        return np.array(self.distortion)

    def project(self, points: Floats, turn: Floats, shift: Floats) -> tuple[Floats, Floats]:
        """Picture points (n, 2) px of points (n, 3) m, and their Jacobian (2n, 15), its columns as `POSE`, `LENS`."""
        seen, jacobian = cv2.projectPoints(points, turn, shift, self.matrix, self.coefficients)
        return np.array(seen.reshape(-1, 2), float), np.array(jacobian[:, :15], float)


@dataclass(frozen=True, slots=True)
class LensFit:
    """residual: RMS distance between the corners seen and those of the model, px.  views: how many were used.

    dropped: in words, which views were not.
    """

    lens: Lens
    residual: float
    views: int
    dropped: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class _Solution:
    """residuals: (n, 2) px for each view; poses: (rotation, translation) of the board in it."""

    lens: Lens
    poses: list[tuple[Floats, Floats]]
    residuals: list[Floats]


def solve_lens(views: Sequence[Sighting]) -> LensFit:
    """The lens that explains the views best; raises CalibrationError with what to do when they do not suffice."""
    _check(views)
    kept = list(range(len(views)))
    solution = _solve([views[number] for number in kept])
    for _ in range(2):
        outlying = _outlying(solution)
        if not outlying or len(kept) - len(outlying) < FEWEST_VIEWS:
            break
        kept = [number for place, number in enumerate(kept) if place not in outlying]
        solution = _solve([views[number] for number in kept])
    return _judged(solution, [views[number] for number in kept], _left_out(len(views), kept))


def _check(views: Sequence[Sighting]) -> None:
    if len(views) < FEWEST_VIEWS:
        raise CalibrationError(
            f"the lens needs at least {FEWEST_VIEWS} different views of the board, got {len(views)}: tilt it, and "
            "bring it to every edge of the picture"
        )
    sizes = {view.size for view in views}
    if len(sizes) > 1:
        raise CalibrationError(f"all views must have one size, got {sorted(sizes)} px: begin anew")


def _left_out(count: int, kept: Sequence[int]) -> tuple[str, ...]:
    return tuple(
        f"view {number + 1} was left out: it does not agree with the others (did the board move?)"
        for number in range(count)
        if number not in kept
    )


def _solve(views: Sequence[Sighting]) -> _Solution:
    objects = [np.column_stack([view.places, np.zeros(len(view.places))]) for view in views]
    try:
        _, matrix, distortion, turns, shifts = cv2.calibrateCamera(
            [places.astype(np.float32) for places in objects],
            [view.pixels.astype(np.float32) for view in views],
            views[0].size,
            np.eye(3),
            np.zeros(5),
        )
    except cv2.error as error:
        raise CalibrationError(
            f"no lens explains these views ({error.err}): tilt the board more, in different directions"
        ) from error
    numbers = [float(number) for number in (*matrix[[0, 1, 0, 1], [0, 1, 2, 2]], *distortion.ravel()[:5])]
    if not all(map(math.isfinite, numbers)):
        raise CalibrationError("no lens explains these views: tilt the board more, in different directions")
    fx, fy, cx, cy, k1, k2, p1, p2, k3 = numbers
    lens = Lens(views[0].size, fx, fy, cx, cy, (k1, k2, p1, p2, k3))
    poses = [
        (np.asarray(turn, float), np.asarray(shift, float)) for turn, shift in zip(turns, shifts, strict=True)
    ]
    residuals = [
        view.pixels - lens.project(places, *pose)[0]
        for view, places, pose in zip(views, objects, poses, strict=True)
    ]
    return _Solution(lens, poses, residuals)


def _outlying(solution: _Solution) -> set[int]:
    each = np.array([_rms(residuals) for residuals in solution.residuals])
    return set(np.flatnonzero(each > OUTLYING * np.median(each)).tolist())


def _rms(residuals: Floats) -> float:
    """Of the distances (n, 2)."""
    return math.sqrt(float(np.mean(np.sum(residuals**2, axis=1))))


def _judged(solution: _Solution, views: Sequence[Sighting], dropped: tuple[str, ...]) -> LensFit:
    residual = _rms(np.vstack(solution.residuals))
    if not residual <= POOREST_RESIDUAL:
        raise CalibrationError(
            f"the views disagree by {residual:.2f} px, at most {POOREST_RESIDUAL:g} px are a calibration: is the board "
            "flat, still while a view is taken, and are its columns, rows and square size right?"
        )
    lens = solution.lens
    covariance = _covariance(solution, views)
    error = _error(lens, covariance)
    if not error <= POOREST_ERROR:
        raise CalibrationError(
            f"the views leave the lens uncertain by {error:.2f} px, {POOREST_ERROR:g} px are allowed: add views with "
            "the board at the edges of the picture"
        )
    focal = math.sqrt(max(covariance[0, 0], 0.0)) / lens.fx
    if not focal <= POOREST_FOCAL:
        raise CalibrationError(
            f"the views leave the focal length uncertain by {focal:.0%}, {POOREST_FOCAL:.0%} are allowed: they are too "
            "alike; add views with the board tilted by 20 degrees or more, in different directions"
        )
    known = Lens(lens.size, lens.fx, lens.fy, lens.cx, lens.cy, lens.distortion, error)
    return LensFit(known, residual, len(views), dropped)


def _covariance(solution: _Solution, views: Sequence[Sighting]) -> Floats:
    """(9, 9) of the lens's figures, the poses of the views being unknown as well (Schur complement)."""
    information, squares, count = np.zeros((9, 9)), 0.0, 0
    for view, pose, residuals in zip(views, solution.poses, solution.residuals, strict=True):
        places = np.column_stack([view.places, np.zeros(len(view.places))])
        _, jacobian = solution.lens.project(places, *pose)
        free = _without(jacobian[:, LENS], jacobian[:, POSE])
        information += free.T @ free
        squares += float(np.sum(residuals**2))
        count += residuals.size
    unknowns = 9 + 6 * len(views)
    return np.array(np.linalg.pinv(information, hermitian=True) * squares / max(count - unknowns, 1), float)


def _without(columns: Floats, others: Floats) -> Floats:
    """What of `columns` no combination of `others` can explain."""
    basis, _ = np.linalg.qr(others)
    return columns - basis @ (basis.T @ columns)


def _error(lens: Lens, covariance: Floats) -> float:
    """RMS, px, of what the lens's uncertainty makes of places in the middle, a plane's pose being fitted to them."""
    half = 0.5 * MIDDLE * min(lens.size)
    steps = np.linspace(-half, half, ACROSS)
    u, v = (grid.ravel() for grid in np.meshgrid(steps, steps))
    places = np.column_stack([u / lens.fx, v / lens.fy, np.zeros(len(u))])
    _, jacobian = lens.project(places, np.zeros(3), np.array([0.0, 0.0, 1.0]))
    left = _without(jacobian[:, LENS], jacobian[:, POSE])
    return math.sqrt(max(float(np.trace(left @ covariance @ left.T)), 0.0) / len(u))
