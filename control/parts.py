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
from control.model import Frame
from control.perception import Perception
from control.safety import Limits


class Camera(Protocol):
    """A source of frames; stamps them with the clock that `now` reads."""

    simulated: bool
    size: tuple[int, int]
    rate: float

    def read(self, timeout: float) -> Frame | None: ...

    def now(self) -> float: ...

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
