"""Is it alive, and what is it doing."""

from __future__ import annotations

from importlib.metadata import version
from itertools import islice
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Query, Request, Response

from server.api import ticks
from server.api.access import TheRig
from server.api.body import StrictRoute
from server.event_log import event_json
from server.watching.health import Pulse

router = APIRouter(tags=["state"], route_class=StrictRoute)

Severity = Literal["info", "warn", "error"]

VERSION = version("pivotrig")


FAILING: dict[int | str, dict[str, Any]] = {
    503: {
        "description": "The program does not do what it is there for; `reason` says why.",
        "content": {"application/json": {"schema": {"type": "object"}}},
    }
}


@router.get("/health", responses=FAILING)
async def health(request: Request, response: Response) -> dict[str, str]:
    """Whether the control loop ticks; for supervisors. A rig in the fault state is a program that works."""
    pulse: Pulse = request.app.state.pulse
    if reason := pulse.failing:
        response.status_code = 503
        return {"status": "failing", "version": VERSION, "reason": reason}
    return {"status": "ok", "version": VERSION}


@router.get("/state")
async def state(rig: TheRig) -> dict[str, Any]:
    """One snapshot of everything."""
    return ticks.state_of(rig)


@router.get("/events")
async def events(
    rig: TheRig,
    severity: Annotated[Severity | None, Query()] = None,
    cursor: Annotated[int, Query(ge=0)] = 0,
    limit: Annotated[int, Query(ge=1, le=500)] = 100,
) -> dict[str, Any]:
    """What happened in this session, newest first; `next` is the cursor of the following page, or null.

    A `number` counts up through the session; a cursor is the number of the last line of the page before, so that
    what happens meanwhile shifts no page. `run_id` is the run that was going on then.
    """
    wanted = islice(
        (
            event
            for event in reversed(rig.events)
            if severity in (None, event.severity) and (not cursor or event.number < cursor)
        ),
        limit + 1,
    )
    listed = [event_json(event) for event in wanted]
    page = listed[:limit]
    return {"events": page, "next": page[-1]["number"] if len(listed) > limit else None}
