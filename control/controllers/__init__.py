"""Controllers: from the robot's pose and the reference to the pivot to stand on and the rate to swing at."""

from control.controllers.controller import Controller, Decision, Situation, controllers
from control.controllers.geometric import Geometric

__all__ = ["Controller", "Decision", "Geometric", "Situation", "controllers"]
