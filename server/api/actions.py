"""Arm, disarm, stop, reset: each answers with the state it led to, or 409 with the reason why not."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter
from pydantic import Field

from server.api import ticks
from server.api.access import TheRig
from server.api.body import StrictRoute
from server.api.operator import TheHand
from server.api.schemas import Edge

router = APIRouter(tags=["rig actions"], route_class=StrictRoute)


class ArmBody(Edge):
    """A real rig needs the operator's consent; a simulated one does not."""

    consent: bool = Field(
        default=False, strict=True, title="Consent",
        description="Current may flow: nobody is at the coils, and nothing magnetic is near them.",
    )  # fmt: skip


@router.post("/arm")
async def arm(rig: TheRig, hand: TheHand, body: ArmBody | None = None) -> dict[str, Any]:
    """Set the board's heading to the estimate and ramp the field up; needs a locked track."""
    await rig.arm(consent=body is not None and body.consent, permit=hand.require)
    return ticks.state_of(rig)


@router.post("/disarm")
async def disarm(rig: TheRig) -> dict[str, Any]:
    """Zero the coils; a run ends."""
    await rig.disarm()
    return ticks.state_of(rig)


@router.post("/estop")
async def estop(rig: TheRig) -> dict[str, Any]:
    """Zero the coils now, whatever else is going on. Always succeeds; a reset and a new arming lead back."""
    await rig.estop()
    return ticks.state_of(rig)


@router.post("/reset")
async def reset(rig: TheRig, hand: TheHand) -> dict[str, Any]:
    """Leave the fault state, disarmed."""
    await rig.reset(hand.require)
    return ticks.state_of(rig)
