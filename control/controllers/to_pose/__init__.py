"""To a pose: chains of sweeps that end at a wanted place with a wanted heading."""

from control.controllers.to_pose.controller import ToPose

__all__ = ["ToPose"]
