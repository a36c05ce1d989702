"""Is it alive, and what is it doing."""

from __future__ import annotations

from importlib.metadata import version
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Query

from server.api import ticks
from server.api.access import TheRig
from server.api.body import StrictRoute

router = APIRouter(tags=["state"], route_class=StrictRoute)

Severity = Literal["info", "warn", "error"]

VERSION = version("pivotrig")


@router.get("/health")
async def health() -> dict[str, str]:
    return {"status": "ok", "version": VERSION}


@router.get("/state")
async def state(rig: TheRig) -> dict[str, Any]:
    """One snapshot of everything."""
    return ticks.state(rig.snapshot)


@router.get("/events")
async def events(
    rig: TheRig,
    severity: Annotated[Severity | None, Query()] = None,
    cursor: Annotated[int, Query(ge=0)] = 0,
    limit: Annotated[int, Query(ge=1, le=500)] = 100,
) -> dict[str, Any]:
    """What happened in this session, newest first; `next` is the cursor of the following page, or null."""
    wanted = [event for event in reversed(rig.events) if severity in (None, event.severity)]
    listed = [
        {
            "time_s": ticks.number(event.time),
            "severity": str(event.severity),
            "code": event.code,
            "message": event.message,
        }
        for event in wanted[cursor : cursor + limit]
    ]
    return {"events": listed, "next": cursor + limit if cursor + limit < len(wanted) else None}
