"""Controllers: from the robot's pose and the reference to the pivot to stand on and the rate to swing at."""

from control.controllers.controller import Controller, Decision, Law, Situation, controllers
from control.controllers.geometric import Geometric
from control.controllers.gradient import Gradient
from control.controllers.heading_hold import Hold
from control.controllers.planner import Planner
from control.controllers.sequence import Sequence
from control.controllers.star import Star
from control.controllers.straight import Straight
from control.controllers.to_pose import ToPose
from control.controllers.wiggle import Wiggle

__all__ = [
    "Controller",
    "Decision",
    "Geometric",
    "Gradient",
    "Hold",
    "Law",
    "Planner",
    "Sequence",
    "Situation",
    "Star",
    "Straight",
    "ToPose",
    "Wiggle",
    "controllers",
]
