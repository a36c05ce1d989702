"""filterpy's extended Kalman filter for a robot that is seen whole: every sighting is a pose (x, y, heading).

The mean is predicted by the exact arc instead of a matrix product, the measurement matrix is the identity, and the
errors of a sighting's three numbers are independent, so that they can be taken in one after the other. filterpy's own
methods are general and spend most of their time on copies and on small matrices; those here are the same algebra for
this case, to the last digits, in plain numbers and a tenth of the time.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from filterpy.kalman import ExtendedKalmanFilter
from numpy.typing import NDArray

from control.model import Pose, wrap
from control.snapshot import Covariance

Matrix = NDArray[np.float64]
Triple = tuple[float, float, float]


def moved(covariance: Covariance, motion: tuple[float, float], noise: Covariance) -> Covariance:
    """The covariance after a motion of the body, F P F' + Q.

    motion: displacement (dx, dy), m. It is fixed in the body's frame, so it turns with the heading:
    F = d(arrival)/d(departure) is the identity but for -dy and dx in the heading's column.
    noise: of the process, Q.
    """
    dx, dy = motion
    xx, xy, xh, yy, yh, hh = covariance
    moved_xh, moved_yh = xh - dy * hh, yh + dx * hh
    return (
        xx - dy * (xh + moved_xh) + noise[0],
        xy + dx * xh - dy * moved_yh + noise[1],
        moved_xh + noise[2],
        yy + dx * (yh + moved_yh) + noise[3],
        moved_yh + noise[4],
        hh + noise[5],
    )


class PivotFilter(ExtendedKalmanFilter):
    """State and sighting: (x, y, heading), m and rad; `x` and `P` as filterpy has them.

    sighting_noise: (3, 3) covariance of a sighting, diagonal.
    """

    def __init__(self, sighting_noise: Matrix) -> None:
        super().__init__(dim_x=3, dim_z=3)
        self.R = sighting_noise
        self._noise: list[float] = np.diag(sighting_noise).tolist()
        self._shift: Triple = (0.0, 0.0, 0.0)
        self._fused: Covariance = self.covariance

    @property
    def x(self) -> Matrix:
        return np.array(self.mean)

    @x.setter
    def x(self, x: Matrix) -> None:
        first, second, third = np.ravel(x).tolist()
        self.mean: Triple = (first, second, third)

    @property
    def P(self) -> Matrix:  # noqa: N802 (filterpy's name)
        xx, xy, xh, yy, yh, hh = self.covariance
        return np.array([[xx, xy, xh], [xy, yy, yh], [xh, yh, hh]])

    @P.setter
    def P(self, P: Matrix) -> None:  # noqa: N802
        (xx, xy, xh), (_, yy, yh), (_, _, hh) = P.tolist()
        self.covariance: Covariance = (xx, xy, xh, yy, yh, hh)

    @property
    def position_sigma(self) -> float:
        """Standard deviation of the position along the worse axis, m."""
        return math.sqrt(max(self.covariance[0], self.covariance[3], 0.0))

    @property
    def heading_sigma(self) -> float:
        """Standard deviation of the heading, rad."""
        return math.sqrt(max(self.covariance[5], 0.0))

    def move(self, arrival: Pose, motion: tuple[float, float], noise: Covariance) -> None:
        """Predict: the arc leads to `arrival`; motion and noise as in `moved`."""
        self.mean = (arrival.x, arrival.y, arrival.heading)
        self.covariance = moved(self.covariance, motion, noise)

    def innovate(self, sighting: Sequence[float]) -> float:
        """Squared Mahalanobis distance of a sighting from the prediction; `fuse` then takes the sighting in.

        One number after the other: each shifts the mean by its gain, takes its share from the covariance, and changes
        what is expected of the next. A variance p that meets noise r leaves p r / (p + r), which stays positive
        whatever is rounded.
        """
        x, y, heading = self.mean
        xx, xy, xh, yy, yh, hh = self.covariance
        noise_x, noise_y, noise_h = self._noise
        ex, ey, eh = sighting[0] - x, sighting[1] - y, wrap(sighting[2] - heading)

        total = xx + noise_x
        gain, left = ex / total, noise_x / total
        distance, dx, dy, dh = ex * gain, xx * gain, xy * gain, xh * gain
        ey, eh = ey - dy, eh - dh
        yy, yh, hh = yy - xy * xy / total, yh - xy * xh / total, hh - xh * xh / total
        xx, xy, xh = xx * left, xy * left, xh * left

        total = yy + noise_y
        gain, left = ey / total, noise_y / total
        distance, dx, dy, dh = distance + ey * gain, dx + xy * gain, dy + yy * gain, dh + yh * gain
        eh -= yh * gain
        xx, xh, hh = xx - xy * xy / total, xh - xy * yh / total, hh - yh * yh / total
        xy, yy, yh = xy * left, yy * left, yh * left

        total = hh + noise_h
        gain, left = eh / total, noise_h / total
        distance, dx, dy, dh = distance + eh * gain, dx + xh * gain, dy + yh * gain, dh + hh * gain
        xx, xy, yy = xx - xh * xh / total, xy - xh * yh / total, yy - yh * yh / total
        self._shift, self._fused = (dx, dy, dh), (xx, xy, xh * left, yy, yh * left, hh * left)
        return distance

    def fuse(self) -> None:
        """Correct the prediction by the sighting that `innovate` has looked at last."""
        (x, y, heading), (dx, dy, turn) = self.mean, self._shift
        self.mean, self.covariance = (x + dx, y + dy, heading + turn), self._fused
