"""The seams at which a simulated rig can be spoilt; everything is right until somebody throws a switch.

The loop, the link and the server know nothing of them: `server.assembly` puts the faulty parts in their places
when it builds a simulated rig, and nowhere else.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Protocol

from control.coil_heat import CoilHeat
from control.model import Pose
from control.simulation.line_faults import LineFaults

Nonsense = Literal["nan", "inf", "text", "nothing", "pivot"]
"""What a controller may return instead of a decision: a rate that is no number, or endless; a text; None; a
pivot that no robot has."""


class CameraSwitches(Protocol):
    """What can be wrong with the pictures; `vision.simulated.camera.Disturbance` is one."""

    hidden: bool
    frozen: bool
    unplugged: bool
    extra_latency: float
    lost: float
    mirrored: bool
    cropped: bool
    timeless: bool
    light: float
    exposure: float
    flicker: float
    glare: bool
    twin: float
    hand: bool
    litter: bool


class Pictures(Protocol):
    """The simulated camera, which moves the world."""

    @property
    def disturbance(self) -> CameraSwitches: ...
    def pass_time(self, duration: float) -> None:
        """Lets rig time pass (s) without a picture."""
        ...

    def jump(self, duration: float) -> None:
        """Puts the clock forward (s)."""
        ...


class BoardSwitches(Protocol):
    """A simulated board's electrics, see `control.simulation.conditions`."""

    def set_condition(self, name: str, value: int, coil: int | None = None) -> None: ...
    def reset(self) -> None: ...


class Robot(Protocol):
    """The world, where the robot can be put down elsewhere."""

    def nudge(self, pose: Pose) -> None: ...


class Heated(Protocol):
    """Who keeps the estimate of the coils' heat: the loop."""

    @property
    def coil_heat(self) -> CoilHeat: ...
    @coil_heat.setter
    def coil_heat(self, heat: CoilHeat, /) -> None: ...


@dataclass(slots=True)
class Sighting:
    """What is wrong with the tracker's measurements.

    not_a_number: the pose is NaN.  offset: added to the position, m.
    """

    not_a_number: bool = False
    offset: tuple[float, float] = (0.0, 0.0)


@dataclass(slots=True)
class Reports:
    """What is wrong with the board's reports once they have been read. not_a_number: their currents are NaN."""

    not_a_number: bool = False


@dataclass(slots=True)
class Decisions:
    """What is wrong with the controller: it raises, hangs for so long (s), or returns nonsense."""

    raises: bool = False
    hangs: float = 0.0
    nonsense: Nonsense | None = None


class DiskSwitches(Protocol):
    """What can be wrong with the disk that recordings go to; `control.simulation.disk_faults.DiskFaults` is one."""

    full: bool
    read_only: bool
    delay: float


@dataclass(frozen=True, slots=True)
class Nominal:
    """What the electrics go back to. supply: mV.  resistances: mohm."""

    supply: int
    resistances: tuple[int, int, int]


@dataclass(frozen=True, slots=True)
class FaultPoints:
    """All seams of one rig."""

    camera: Pictures
    line: LineFaults
    board: BoardSwitches
    robot: Robot
    nominal: Nominal
    coils: Heated
    sighting: Sighting
    reports: Reports
    decisions: Decisions
    disk: DiskSwitches
