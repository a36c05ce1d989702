"""Drive by hand: one jog at a time, each good for 300 ms."""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Request
from pydantic import Field, model_validator

from control.controllers.manual import Jog
from server.api import ticks
from server.api.access import TheRig
from server.api.body import StrictRoute
from server.api.operator import TheHand
from server.api.schemas import Edge
from server.jog_order import JogOrder

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
    hand: Annotated[str, Field(min_length=1, max_length=40)] | None = Field(
        default=None,
        title="Hand",
        description="Who jogs; with a number, so that a late jog starts nothing again.",
    )
    number: Annotated[int, Field(ge=0, le=2**53)] | None = Field(
        default=None,
        title="Number",
        description="Of the jogs of this hand; each has a higher one than the last.",
    )

    @model_validator(mode="after")
    def _number_of_a_hand(self) -> JogBody:
        if (self.hand is None) != (self.number is None):
            raise ValueError("hand and number come together: send both, or neither")
        return self

    def to_si(self) -> Jog:
        tilt = None if self.tilt_deg is None else math.radians(self.tilt_deg)
        return Jog(self.pivot, math.radians(self.rate_deg_s), tilt)


def order_of(request: Request) -> JogOrder:
    return request.app.state.jog_order


@router.post("/manual")
async def manual(body: JogBody, request: Request, rig: TheRig, hand: TheHand) -> dict[str, Any]:
    """Swing about a pivot for at most 300 ms; the rig must be armed and no run going on. A rate of 0 stops at once."""
    if body.hand is not None and body.number is not None:
        order_of(request).take(body.hand, body.number)
    await rig.jog(body.to_si(), hand.require)
    return ticks.state_of(rig)
