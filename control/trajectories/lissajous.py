"""Lissajous figures."""

from __future__ import annotations

import math

from pydantic import Field

from control.model import TURN
from control.registry import Parameters
from control.trajectories.fields import SMALLEST_MM, degrees, millimetres
from control.trajectories.trajectory import MM, trajectories


class LissajousParameters(Parameters):
    width_mm: float = millimetres(80.0, "Width", "Extent along x.", least=SMALLEST_MM)
    height_mm: float = millimetres(80.0, "Height", "Extent along y.", least=SMALLEST_MM)
    frequency_x: int = Field(default=3, ge=1, le=9, title="Waves along x", json_schema_extra={"unit": "1"})
    frequency_y: int = Field(default=2, ge=1, le=9, title="Waves along y", json_schema_extra={"unit": "1"})
    phase_deg: float = degrees(90.0, "Phase", "Of the wave along x, when the one along y starts at zero.")
    period_s: float = Field(
        default=200.0, ge=1.0, le=36000.0, title="Period",
        description="Time for one full figure at a path step of 0.1 s.", json_schema_extra={"unit": "s"},
    )  # fmt: skip


@trajectories.register
class Lissajous:
    """x = a sin(p w t + phase), y = b sin(q w t), with the common factor of p and q taken out."""

    name = "lissajous"
    title = "Lissajous"
    summary = "Two waves across each other; its speed changes along the way."
    Parameters = LissajousParameters
    closed = True

    def __init__(self, parameters: LissajousParameters) -> None:
        common = math.gcd(parameters.frequency_x, parameters.frequency_y)
        self._waves = parameters.frequency_x // common, parameters.frequency_y // common
        self._phase = math.radians(parameters.phase_deg)
        self._half_width = 0.5 * parameters.width_mm * MM
        self._half_height = 0.5 * parameters.height_mm * MM
        self.duration = parameters.period_s

    def point(self, time: float) -> tuple[float, float]:
        angle = TURN * time / self.duration
        across, up = self._waves
        x = self._half_width * math.sin(across * angle + self._phase)
        return x, self._half_height * math.sin(up * angle)
