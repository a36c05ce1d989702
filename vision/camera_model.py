"""Lens and plane: from workspace points to picture points and back.

A pinhole with the Brown-Conrady lens model, as OpenCV writes it (k1, k2, p1, p2, k3). Lens and plane are
applied to points, never to whole frames. The picture frame is (u, v) in px, u to the right, v down, whole
numbers at pixel centres; the workspace frame is (x, y, z) in m with z up from the plate.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
Value = TypeVar("Value", float, Points)
"""The formulas hold for one number and for an array of them alike."""

Row = tuple[float, float, float]
Rotation = tuple[Row, Row, Row]

LENS_TOLERANCE = 1e-10
"""Where the inversion of the lens stops, in normalised picture units (about 1e-7 px)."""
LENS_ITERATIONS = 50
"""Ample: a lens of this mild kind needs 6; one that needs more than 50 folds the picture over itself."""

PICTURE_HEIGHT_ON_PLATE = 0.130
"""Default optics: length on the plate that spans the picture's height, m (the 120 mm workspace and a rim)."""
CAMERA_HEIGHT = 0.35
"""Default optics: distance from the lens to the coil centre, m (assumed; clear of the coils)."""
CAMERA_TILT = math.radians(1.5)
"""Default optics: how far the camera is from looking straight down, rad (assumed; a camera hung by hand)."""
MILD_BARREL = (-0.12, 0.02, 0.0, 0.0, 0.0)
"""Default optics: an ordinary C-mount lens, 1 % barrel in the corners (assumed)."""


class CalibrationError(ValueError):
    """A calibration that cannot be used; the text says which value, what is allowed and in which unit."""


def _largest(shift_p: float | Points, shift_q: float | Points) -> float:
    """Largest squared shift; 0 for no points at all."""
    squares = shift_p * shift_p + shift_q * shift_q
    return squares if isinstance(squares, float) else float(np.max(squares, initial=0.0))


def _turned_down(tilt_x: float, tilt_y: float) -> Rotation:
    """Workspace -> camera for a camera above, turned about its own x and y axes by the tilts, rad."""
    cx, sx, cy, sy = math.cos(tilt_x), math.sin(tilt_x), math.cos(tilt_y), math.sin(tilt_y)
    about_x = np.array([[1.0, 0.0, 0.0], [0.0, cx, -sx], [0.0, sx, cx]])
    about_y = np.array([[cy, 0.0, sy], [0.0, 1.0, 0.0], [-sy, 0.0, cy]])
    first, second, third = (about_x @ about_y @ np.diag([1.0, -1.0, -1.0])).tolist()
    return tuple(first), tuple(second), tuple(third)


@dataclass(frozen=True, slots=True)
class CameraModel:
    """One calibrated camera.

    size: (width, height) of the picture it holds for, px.  fx, fy, cx, cy: pinhole, px.
    distortion: k1, k2, p1, p2, k3 (Brown-Conrady, OpenCV's order, dimensionless).
    rotation, translation: a workspace point p (m) is R p + t in the camera frame (x right, y down, z ahead).
    """

    size: tuple[int, int]
    fx: float
    fy: float
    cx: float
    cy: float
    distortion: tuple[float, float, float, float, float]
    rotation: Rotation
    translation: Row

    def __post_init__(self) -> None:
        numbers = [self.fx, self.fy, self.cx, self.cy, *self.distortion, *self.translation]
        numbers += [value for row in self.rotation for value in row]
        if not all(math.isfinite(value) for value in numbers):
            raise CalibrationError(f"a camera calibration needs finite numbers, got {numbers}")
        if not (self.fx > 0.0 and self.fy > 0.0 and min(self.size) > 0):
            raise CalibrationError(
                f"focal lengths and size must be above 0 px, got fx {self.fx}, fy {self.fy}, size {self.size}"
            )
        matrix = np.array(self.rotation)
        if np.abs(matrix @ matrix.T - np.eye(3)).max() > 1e-6 or np.linalg.det(matrix) < 0.0:
            raise CalibrationError(
                f"the camera's rotation must be a proper rotation matrix, got {self.rotation}"
            )

    @classmethod
    def looking_down(
        cls,
        size: tuple[int, int] = (640, 480),
        height: float = CAMERA_HEIGHT,
        picture_height: float = PICTURE_HEIGHT_ON_PLATE,
        tilt: tuple[float, float] = (CAMERA_TILT, 0.0),
        distortion: tuple[float, float, float, float, float] = MILD_BARREL,
    ) -> CameraModel:
        """A camera above the coil centre, which it sees in the middle of its picture, workspace y up.

        height: from lens to coil centre, m.  picture_height: length on the plate that fills the height, m.
        tilt: small turns about the camera's x and y axes, rad.
        """
        width_px, height_px = size
        focal = height * height_px / picture_height
        centre_u, centre_v = 0.5 * (width_px - 1), 0.5 * (height_px - 1)
        rotation = _turned_down(*tilt)
        return cls(size, focal, focal, centre_u, centre_v, distortion, rotation, (0.0, 0.0, height))

    def to_pixel(self, x: float, y: float, height: float = 0.0) -> tuple[float, float]:
        """Picture point (px) of one workspace point (m) at `height` (m) above the plate."""
        return self._project(x, y, height)

    def to_point(self, u: float, v: float, height: float = 0.0) -> tuple[float, float]:
        """Workspace point (m) at `height` (m) that is seen at one picture point (px)."""
        p, q = self._undistort_one((u - self.cx) / self.fx, (v - self.cy) / self.fy)
        return self._meet_plane(p, q, height)

    def to_image(self, points: Points, height: float = 0.0) -> Points:
        """Picture points (n, 2) px of workspace points (n, 2) m at `height` (m) above the plate."""
        x, y = np.asarray(points, dtype=float).reshape(-1, 2).T
        return np.column_stack(self._project(x, y, height))

    def to_workspace(self, points: Points, height: float = 0.0) -> Points:
        """Workspace points (n, 2) m at `height` (m) that are seen at picture points (n, 2) px."""
        u, v = np.asarray(points, dtype=float).reshape(-1, 2).T
        p, q = self._undistort((u - self.cx) / self.fx, (v - self.cy) / self.fy)
        return np.column_stack(self._meet_plane(p, q, height))

    def scale_at(self, x: float, y: float, height: float = 0.0) -> float:
        """Local scale of the picture at a workspace point (m): the root of the area ratio, px/m."""
        step = 1e-4
        u0, v0 = self.to_pixel(x, y, height)
        u1, v1 = self.to_pixel(x + step, y, height)
        u2, v2 = self.to_pixel(x, y + step, height)
        return math.sqrt(abs((u1 - u0) * (v2 - v0) - (u2 - u0) * (v1 - v0))) / step

    def _project(self, x: Value, y: Value, height: float) -> tuple[Value, Value]:
        (a, b, c), (d, e, f), (g, h, i) = self.rotation
        tx, ty, tz = self.translation
        depth = g * x + h * y + (i * height + tz)
        ahead_x, ahead_y = a * x + b * y + (c * height + tx), d * x + e * y + (f * height + ty)
        p, q = self._distort(ahead_x / depth, ahead_y / depth)
        return self.fx * p + self.cx, self.fy * q + self.cy

    def _meet_plane(self, p: Value, q: Value, height: float) -> tuple[Value, Value]:
        """Where the ray through the undistorted normalised point (p, q) meets the plane z = height.

        Two linear equations in (x, y): in the camera frame, ahead_x - p depth = 0 and ahead_y - q depth = 0.
        """
        (a, b, c), (d, e, f), (g, h, i) = self.rotation
        tx, ty, tz = self.translation
        a1, b1, c1 = a - p * g, b - p * h, p * (i * height + tz) - (c * height + tx)
        a2, b2, c2 = d - q * g, e - q * h, q * (i * height + tz) - (f * height + ty)
        determinant = a1 * b2 - a2 * b1
        return (c1 * b2 - c2 * b1) / determinant, (a1 * c2 - a2 * c1) / determinant

    def _distort(self, p: Value, q: Value) -> tuple[Value, Value]:
        """Brown-Conrady, ideal -> seen, normalised."""
        k1, k2, p1, p2, k3 = self.distortion
        r2 = p * p + q * q
        radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))
        return (
            p * radial + 2.0 * p1 * p * q + p2 * (r2 + 2.0 * p * p),
            q * radial + p1 * (r2 + 2.0 * q * q) + 2.0 * p2 * p * q,
        )

    def _undistort(self, seen_p: Value, seen_q: Value) -> tuple[Value, Value]:
        """Inverse of `_distort` by fixed-point iteration on the shift that the lens makes."""
        p, q = seen_p, seen_q
        for _ in range(LENS_ITERATIONS):
            again_p, again_q = self._distort(p, q)
            shift_p, shift_q = seen_p - again_p, seen_q - again_q
            p, q = p + shift_p, q + shift_q
            if _largest(shift_p, shift_q) < LENS_TOLERANCE**2:
                break
        return p, q

    def _undistort_one(self, seen_p: float, seen_q: float) -> tuple[float, float]:
        """The same for one point, several times in each frame: by the ratio that the lens makes (OpenCV's iteration),
        which needs half as many rounds. It ends where the next round would move the point less than the tolerance:
        each round's move is the same share of the last one."""
        k1, k2, p1, p2, k3 = self.distortion
        p, q = seen_p, seen_q
        last = 0.0
        for _ in range(LENS_ITERATIONS):
            pp, pq, qq = p * p, 2.0 * p * q, q * q
            r2 = pp + qq
            radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))
            if not radial > 0.0:  # far outside the picture, where the formula folds it over itself
                break
            next_p = (seen_p - p1 * pq - p2 * (r2 + 2.0 * pp)) / radial
            next_q = (seen_q - p1 * (r2 + 2.0 * qq) - p2 * pq) / radial
            move = abs(next_p - p) + abs(next_q - q)
            p, q = next_p, next_q
            if move < LENS_TOLERANCE or move * move < LENS_TOLERANCE * last:
                break
            last = move
        return p, q
