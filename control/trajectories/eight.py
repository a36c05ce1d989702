"""The paper's figure eight (section 5)."""

from __future__ import annotations

import math

from pydantic import Field

from control.model import TURN
from control.registry import Parameters
from control.trajectories.fields import SMALLEST_MM, millimetres
from control.trajectories.trajectory import MM, trajectories

PAPER_PERIOD = 40.0 * math.pi
"""One full eight in the paper: y = -40 cos(0.05 t) mm, s."""


class EightParameters(Parameters):
    width_mm: float = millimetres(80.0, "Width", "Extent along x.", least=SMALLEST_MM)
    height_mm: float = millimetres(80.0, "Height", "Extent along y.", least=SMALLEST_MM)
    period_s: float = Field(
        default=round(PAPER_PERIOD, 6), ge=1.0, le=36000.0, title="Period",
        description="Time for one full eight at a path step of 0.1 s.", json_schema_extra={"unit": "s"},
    )  # fmt: skip


@trajectories.register
class Eight:
    """x = -a sin(2 w t), y = -b cos(w t); the paper has a = b = 40 mm and w = 0.05 rad/s."""

    name = "eight"
    title = "Figure eight"
    summary = "The paper's eight: starts at the bottom, walks both lobes, comes back."
    Parameters = EightParameters
    closed = True

    def __init__(self, parameters: EightParameters) -> None:
        self.duration = parameters.period_s
        self._half_width = 0.5 * parameters.width_mm * MM
        self._half_height = 0.5 * parameters.height_mm * MM

    def point(self, time: float) -> tuple[float, float]:
        phase = TURN * time / self.duration
        return -self._half_width * math.sin(2.0 * phase), -self._half_height * math.cos(phase)
