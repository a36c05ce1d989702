"""The whole of a recorded run at a glance, for a page that shows it again."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Annotated

import msgspec
from fastapi import APIRouter, Response
from pydantic import Field

from server.api.access import TheArchive
from server.api.problems import Problem, Rejected
from server.api.recorded import path_of, record_of
from server.recording.reading import Recording, Unreadable
from server.replay.overview import overview_of

if TYPE_CHECKING:
    from server.archive import Archive

router = APIRouter(tags=["runs"])


@router.get("/runs/{run_id}/overview", response_class=Response)
async def overview(run_id: Annotated[str, Field(max_length=80)], archive: TheArchive) -> Response:
    """Its curves in at most 2 000 points, its events, its path and its camera; times since its start."""
    content = await asyncio.to_thread(overview_json, archive, run_id)
    return Response(content, media_type="application/json")


def overview_json(archive: Archive, run_id: str) -> bytes:
    record, path = record_of(archive, run_id), path_of(archive, run_id)
    try:
        with Recording.open(path) as recording:
            return msgspec.json.encode({"id": record.id, "label": record.label, **overview_of(recording)})
    except Unreadable as error:
        raise Rejected(Problem(409, "Unreadable", str(error))) from error
