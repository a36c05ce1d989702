"""What the loop is made of, and the camera that its shell reads."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from control.actuation import Actuation
from control.coil_heat import ThermalLimits
from control.coils import CoilSet
from control.controllers import Law
from control.field_model import FieldModel
from control.gait_model import GaitModel
from control.link.port import Link
from control.model import CameraNote, Frame
from control.perception import Perception
from control.safety import Limits


class Camera(Protocol):
    """A source of frames; stamps them with the clock that `now` reads.

    identity: what tells this camera from others, "" until it could be opened for the first time.
    trouble: why there are no frames, in words; "" while the camera is open.
    """

    simulated: bool
    size: tuple[int, int]
    rate: float

    @property
    def identity(self) -> str: ...

    @property
    def trouble(self) -> str: ...

    def require(self) -> None:
        """Returns once the camera is open; raises RuntimeError with what is in the way."""
        ...

    def read(self, timeout: float) -> Frame | None: ...

    def now(self) -> float: ...

    def take_notes(self) -> list[CameraNote]:
        """What happened to it since the last call, oldest first."""
        ...

    def close(self) -> None: ...


@dataclass(frozen=True, slots=True)
class Parts:
    """What the loop is made of; `server.assembly` builds it from the rig file."""

    perception: Perception
    actuation: Actuation
    field: FieldModel
    link: Link
    coils: CoilSet
    limits: Limits
    thermal: ThermalLimits
    frame_size: tuple[int, int]
    """Width and height of the camera's pictures, px."""
    length: float
    simulated: bool
    gait_model: GaitModel
    """What is known of a pivot switch before the run begins."""
    body_tilt: Callable[[float], float]
    """From the field's tilt to the body's, rad, for drawing."""
    controller_case: Callable[[Law], Law]
    """What every controller is put into before it walks; the controller itself on a real rig."""
    camera_trouble: Callable[[], str]
    """Why the camera gives no frames, "" while it is open."""
    calibration_problem: Callable[[], str]
    """Why the saved calibration is not that of the camera that is open, "" when it is."""
