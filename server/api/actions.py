"""Arm, disarm, stop, reset: each answers with the state it led to, or 409 with the reason why not."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter

from server.api import ticks
from server.api.access import TheRig
from server.api.body import StrictRoute

router = APIRouter(tags=["rig actions"], route_class=StrictRoute)


@router.post("/arm")
async def arm(rig: TheRig) -> dict[str, Any]:
    """Set the board's heading to the estimate and ramp the field up; needs a locked track."""
    await rig.arm()
    return ticks.state(rig.snapshot)


@router.post("/disarm")
async def disarm(rig: TheRig) -> dict[str, Any]:
    """Zero the coils; a run ends."""
    await rig.disarm()
    return ticks.state(rig.snapshot)


@router.post("/estop")
async def estop(rig: TheRig) -> dict[str, Any]:
    """Zero the coils now, whatever else is going on. Always succeeds; a reset and a new arming lead back."""
    await rig.estop()
    return ticks.state(rig.snapshot)


@router.post("/reset")
async def reset(rig: TheRig) -> dict[str, Any]:
    """Leave the fault state, disarmed."""
    await rig.reset()
    return ticks.state(rig.snapshot)
