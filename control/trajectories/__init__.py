"""Reference paths: where the robot's centre should be, as a function of the reference clock."""

from control.trajectories.circle import Circle
from control.trajectories.eight import Eight
from control.trajectories.letters import Letter
from control.trajectories.line import Line
from control.trajectories.lissajous import Lissajous
from control.trajectories.polygon import Polygon
from control.trajectories.spiral import Spiral
from control.trajectories.trajectory import OutsideWorkspace, Path, Trajectory, check_inside, trajectories
from control.trajectories.waypoints import Waypoints

__all__ = [
    "Circle",
    "Eight",
    "Letter",
    "Line",
    "Lissajous",
    "OutsideWorkspace",
    "Path",
    "Polygon",
    "Spiral",
    "Trajectory",
    "Waypoints",
    "check_inside",
    "trajectories",
]
