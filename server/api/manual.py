"""Drive by hand: one jog at a time, each good for 300 ms."""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

from fastapi import APIRouter
from pydantic import Field

from control.controllers.manual import Jog
from server.api import ticks
from server.api.access import TheRig
from server.api.body import StrictRoute
from server.api.schemas import Edge

router = APIRouter(tags=["manual"], route_class=StrictRoute)


class JogBody(Edge):
    """Send it again, a few times a second, for as long as the robot should move."""

    pivot: Literal[1, -1] = Field(title="Pivot", description="The end to stand on: 1 is A, -1 is B.")
    rate_deg_s: Annotated[float, Field(gt=-360.0, lt=360.0)] = Field(
        title="Rate", description="Counter-clockwise is positive.", json_schema_extra={"unit": "°/s"}
    )
    tilt_deg: Annotated[float, Field(ge=0.0, lt=60.0)] | None = Field(
        default=None, title="Tilt", description="Of the field; left out, it stays as it is.",
        json_schema_extra={"unit": "°"},
    )  # fmt: skip

    def to_si(self) -> Jog:
        tilt = None if self.tilt_deg is None else math.radians(self.tilt_deg)
        return Jog(self.pivot, math.radians(self.rate_deg_s), tilt)


@router.post("/manual")
async def manual(body: JogBody, rig: TheRig) -> dict[str, Any]:
    """Swing about a pivot for at most 300 ms; the rig must be armed and no run going on."""
    await rig.jog(body.to_si())
    return ticks.state(rig.snapshot)
