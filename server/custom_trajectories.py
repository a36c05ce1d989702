"""Paths that somebody drew or sent, by name; kept for this session."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from control.safety import Refused
from control.trajectories.custom import TooManyPaths, save_path
from control.trajectories.waypoints import Smoothing


class CustomTrajectories:
    """What the page and scripts may add to the trajectories."""

    def save(
        self, name: str, points: NDArray[np.float64], closed: bool, speed: float, kind: Smoothing
    ) -> None:
        """Keep a path ((n, 2) points, m; m/s) under a free name; raises `Refused` when there are too many."""
        try:
            save_path(name, points, closed, speed, kind)
        except TooManyPaths as error:
            raise Refused(str(error)) from error
