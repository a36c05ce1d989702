"""The planner: a receding-horizon search over chains of sweeps."""

from control.controllers.planner.controller import Planner
from control.controllers.planner.parameters import PlannerParameters

__all__ = ["Planner", "PlannerParameters"]
