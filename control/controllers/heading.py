"""Which way a robot should face while it follows a path, for the controllers that can regulate heading."""

from __future__ import annotations

import math
from typing import Literal

from pydantic import Field

from control.controllers.controller import Situation
from control.model import wrap
from control.registry import Parameters

TANGENT_STEP = 0.05
"""The path's direction is that of the desired point's motion over this time, s."""
STILL = 1e-9
"""A desired point that moves less than this meanwhile, m, stands still and has no direction."""


class HeadingParameters(Parameters):
    heading: Literal["free", "along", "across", "fixed"] = Field(
        default="free",
        title="Heading",
        description="free: position only; along or across the path; fixed: the angle below.",
        json_schema_extra={"live": True},
    )
    heading_deg: float = Field(
        default=0.0, ge=-360.0, le=360.0, title="Fixed heading", description="For a fixed heading.",
        json_schema_extra={"unit": "°", "live": True, "step": 5},
    )  # fmt: skip
    heading_weight: float = Field(
        default=0.01, ge=0.0, le=100.0, title="Heading weight",
        description="At 1, a heading error of one radian counts like a position error of one robot length.",
        json_schema_extra={"unit": "1", "live": True, "step": 0.01},
    )  # fmt: skip

    @property
    def effective_heading_weight(self) -> float:
        """0 for a pure position task."""
        return 0.0 if self.heading == "free" else self.heading_weight


class WantedHeading:
    """The wanted heading at any time ahead; where the path stands still, the last one known."""

    def __init__(self, parameters: HeadingParameters) -> None:
        self._mode = parameters.heading
        self._fixed = math.radians(parameters.heading_deg)
        self._tangent: float | None = None

    def at(self, situation: Situation, ahead: float) -> float:
        """The heading wanted `ahead` seconds from now, rad; across the path the nearer of the two."""
        if self._mode == "fixed":
            return self._fixed
        tangent = self._tangent_at(situation, ahead)
        if self._mode != "across":
            return tangent
        side = wrap(situation.pose.heading - tangent)
        return tangent + math.copysign(0.5 * math.pi, side)

    def _tangent_at(self, situation: Situation, ahead: float) -> float:
        x0, y0 = situation.desired(ahead)
        x1, y1 = situation.desired(ahead + TANGENT_STEP)
        if math.hypot(x1 - x0, y1 - y0) > STILL:
            self._tangent = math.atan2(y1 - y0, x1 - x0)
        return situation.pose.heading if self._tangent is None else self._tangent
