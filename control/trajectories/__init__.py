"""Reference paths: where the robot's centre should be, as a function of the reference clock."""

from control.trajectories.circle import Circle
from control.trajectories.eight import Eight
from control.trajectories.line import Line
from control.trajectories.trajectory import OutsideWorkspace, Trajectory, check_inside, trajectories
from control.trajectories.waypoints import Waypoints

__all__ = [
    "Circle",
    "Eight",
    "Line",
    "OutsideWorkspace",
    "Trajectory",
    "Waypoints",
    "check_inside",
    "trajectories",
]
