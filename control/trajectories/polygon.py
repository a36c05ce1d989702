"""A regular polygon with rounded corners, walked at constant speed."""

from __future__ import annotations

import math

from pydantic import Field, model_validator

from control.model import TURN
from control.registry import Parameters
from control.trajectories.fields import SMALLEST_MM, degrees, millimetres, speed
from control.trajectories.pieces import rounded
from control.trajectories.trajectory import MM, passed, trajectories


class PolygonParameters(Parameters):
    corners: int = Field(default=4, ge=3, le=24, title="Corners", json_schema_extra={"unit": "1"})
    radius_mm: float = millimetres(
        45.0, "Radius", "From the centre to a corner, before rounding.", least=SMALLEST_MM
    )
    corner_radius_mm: float = millimetres(6.0, "Corner radius", "0 for sharp corners.", least=0.0)
    rotation_deg: float = degrees(45.0, "Rotation", "0: the first corner is straight below the centre.")
    speed_mm_s: float = speed()

    @model_validator(mode="after")
    def _corners_fit(self) -> PolygonParameters:
        largest = self.radius_mm * math.cos(math.pi / self.corners)
        if not self.corner_radius_mm <= largest:
            raise ValueError(
                f"the corner radius, {self.corner_radius_mm:g} mm, must be at most {largest:.4g} mm, "
                "the radius of the circle inside the polygon"
            )
        return self


@trajectories.register
class Polygon:
    """Anticlockwise from the middle of the side that follows the first corner."""

    name = "polygon"
    title = "Polygon"
    summary = "A regular polygon with rounded corners at constant speed."
    Parameters = PolygonParameters
    closed = True

    def __init__(self, parameters: PolygonParameters) -> None:
        first = math.radians(parameters.rotation_deg) - 0.5 * math.pi
        radius = parameters.radius_mm * MM
        angles = [first + TURN * number / parameters.corners for number in range(parameters.corners)]
        corners = [(radius * math.cos(angle), radius * math.sin(angle)) for angle in angles]
        self._chain = rounded(corners, parameters.corner_radius_mm * MM, closed=True)
        self._speed = parameters.speed_mm_s * MM
        self.duration = self._chain.length / self._speed

    def point(self, time: float) -> tuple[float, float]:
        return self._chain.at(self._speed * passed(time, self.duration, self.closed))
