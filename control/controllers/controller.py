"""What a controller sees and says, and the registry of all of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

from control.gait import Gait
from control.gait_model import GaitModel
from control.model import Pivot, Pose
from control.registry import Parameters, Registry
from control.trajectories.trajectory import Path


@dataclass(frozen=True, slots=True)
class Situation:
    """The moment of a decision.

    pose: the estimate now.  pivot: the one in use.  may_switch: a sweep has just been completed, so the
    pivot may be chosen again.  turned: how far the body has come in its sweep, rad, signed.
    reference: the desired point now, m.  trajectory, reference_time: to look ahead along the path, whose clock
    is the rig's: in `dt` seconds the desired point will be `trajectory.point(reference_time + dt)`, m.
    length: distance between the pivots, m.
    workspace: half the side of the square that the centre must not leave, m; None where there is no edge.
    slip: what a pivot switch does to this robot and how long it takes; None where that is not known.
    """

    pose: Pose
    pivot: Pivot
    may_switch: bool
    turned: float
    reference: tuple[float, float]
    trajectory: Path
    reference_time: float
    gait: Gait
    length: float
    workspace: float | None = None
    slip: GaitModel | None = None

    def desired(self, ahead: float) -> tuple[float, float]:
        """The desired point `ahead` seconds of rig time from now, m."""
        return self.trajectory.point(self.reference_time + ahead)


@dataclass(frozen=True, slots=True)
class Decision:
    """pivot: the one to stand on; ignored unless the situation allows a switch.  rate: rad/s, signed.

    sweep: the turn at which the sweep under way is complete, rad, in (0, 2 pi]; None for the gait's own.
    finished: there is nothing left to do, and the run may end.
    """

    pivot: Pivot
    rate: float
    sweep: float | None = None
    finished: bool = False


class Law(Protocol):
    """Pure: no clock, no I/O; whatever it remembers is its own."""

    name: str

    def step(self, situation: Situation) -> Decision: ...


class Controller(Law, Protocol):
    """A law that can be chosen, with its parameters."""

    title: str
    summary: str
    Parameters: type[Parameters]

    def __init__(self, parameters: Any) -> None: ...


controllers: Registry[Controller] = Registry("controller")
