"""What a controller sees and says, and the registry of all of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

from control.gait import Gait
from control.model import Pivot, Pose
from control.registry import Parameters, Registry
from control.trajectories.trajectory import Trajectory


@dataclass(frozen=True, slots=True)
class Situation:
    """The moment of a decision.

    pose: the estimate now.  pivot: the one in use.  may_switch: a sweep has just been completed, so the
    pivot may be chosen again.  turned: how far the body has come in its sweep, rad, signed.
    reference: the desired point now, m.  trajectory, reference_time: to look ahead along the path.
    length: distance between the pivots, m.
    """

    pose: Pose
    pivot: Pivot
    may_switch: bool
    turned: float
    reference: tuple[float, float]
    trajectory: Trajectory
    reference_time: float
    gait: Gait
    length: float


@dataclass(frozen=True, slots=True)
class Decision:
    """pivot: the one to stand on; ignored unless the situation allows a switch.  rate: rad/s, signed."""

    pivot: Pivot
    rate: float


class Controller(Protocol):
    """Pure law: no clock, no I/O; whatever it remembers is its own."""

    name: str
    title: str
    summary: str
    Parameters: type[Parameters]

    def __init__(self, parameters: Any) -> None: ...

    def step(self, situation: Situation) -> Decision: ...


controllers: Registry[Controller] = Registry("controller")
