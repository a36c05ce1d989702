"""All runs that there are: list, look at, edit, delete."""

from __future__ import annotations

import asyncio
from typing import Annotated, Any

from fastapi import APIRouter, Query, Response
from pydantic import Field

from server.api.access import TheArchive, TheRig
from server.api.body import StrictRoute
from server.api.run_bodies import PruneBody, RunEdit, RunFilter
from server.api.run_listing import Asked, one_json, page_json
from server.api.runs import current
from server.catalogue.deleting import delete_run
from server.catalogue.edits import edit
from server.catalogue.errors import NoSuchRun
from server.catalogue.record_json import record_json, time_text
from server.catalogue.records import Loose
from server.catalogue.retention import prunable, prune

router = APIRouter(tags=["runs"], route_class=StrictRoute)

RunId = Annotated[str, Field(max_length=80)]


@router.get("/runs")
async def list_runs(
    wanted: Annotated[RunFilter, Query()], rig: TheRig, archive: TheArchive
) -> dict[str, Any]:
    """Newest first; `next` is the cursor of the following page, or null; `total` is what the filter finds."""
    asked = Asked(wanted.query(), wanted.cursor, wanted.limit)
    return await asyncio.to_thread(page_json, rig, archive, asked)


@router.get("/runs/{run_id}")
async def one(run_id: RunId, rig: TheRig, archive: TheArchive) -> dict[str, Any]:
    """A run with the settings that made it; `current` is the one that goes on."""
    id = current(list(rig.runs)).id if run_id == "current" else run_id
    return await asyncio.to_thread(one_json, rig, archive, id)


@router.patch("/runs/{run_id}")
async def change(run_id: RunId, body: RunEdit, rig: TheRig, archive: TheArchive) -> dict[str, Any]:
    """Label, tags, notes and pin."""
    changes = body.model_dump(exclude_none=True)
    answer = record_json(await asyncio.to_thread(edit, archive, run_id, changes))
    rig.announcements.publish({"type": "run", "event": "edited", "run": answer})
    return answer


@router.delete("/runs/{run_id}", status_code=204)
async def delete(run_id: RunId, rig: TheRig, archive: TheArchive) -> Response:
    """The run and its recording; a pinned one, or one that goes on, is refused."""
    try:
        await asyncio.to_thread(delete_run, archive, run_id)
    except NoSuchRun:
        if not rig.runs.forget(run_id):
            raise
    rig.runs.forget(run_id)
    rig.announcements.publish({"type": "run", "event": "deleted", "run": {"id": run_id}})
    return Response(status_code=204)


@router.post("/runs/prune")
async def prune_runs(body: PruneBody, rig: TheRig, archive: TheArchive) -> dict[str, Any]:
    """Delete old runs, or the oldest; `dry_run` only says which. Pinned ones and one that goes on stay."""
    gone = await asyncio.to_thread(prunable if body.dry_run else prune, archive, body.policy())
    if not body.dry_run:
        for run in gone:
            rig.runs.forget(run.id)
        rig.announcements.publish({"type": "run", "event": "pruned", "run": None, "runs": len(gone)})
    return {"runs": [loose_json(run) for run in gone], "bytes": sum(run.size_bytes for run in gone)}


def loose_json(run: Loose) -> dict[str, Any]:
    return {
        "id": run.id,
        "label": run.label,
        "started_at": time_text(run.started_at),
        "recording": {"size_bytes": run.size_bytes},
    }
