"""The whole of a recorded run at a glance, for a page that shows it again."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated

import msgspec
from fastapi import APIRouter, Query, Response
from pydantic import Field

from server.api.access import TheArchive
from server.api.problems import Problem, Rejected
from server.api.recorded import path_of, record_of
from server.api.replay import LONGEST
from server.recording.reading.recording import Recording, Unreadable
from server.replay.overview import overview_of
from server.replay.series import computed_series

if TYPE_CHECKING:
    from server.archive import Archive

router = APIRouter(tags=["runs"])


@router.get("/runs/{run_id}/overview", response_class=Response)
async def overview(run_id: Annotated[str, Field(max_length=80)], archive: TheArchive) -> Response:
    """Its curves in at most 2 000 points, its events, its path and its camera; times since its start."""
    content = await asyncio.to_thread(overview_json, archive, run_id)
    return Response(content, media_type="application/json")


@router.get("/runs/{run_id}/series", response_class=Response)
async def series(
    run_id: Annotated[str, Field(max_length=80)],
    archive: TheArchive,
    start_s: Annotated[float, Query(ge=0.0, le=LONGEST, allow_inf_nan=False)] = 0.0,
    end_s: Annotated[float, Query(ge=0.0, le=LONGEST, allow_inf_nan=False)] = LONGEST,
) -> Response:
    """The curves of a part of it, closer than the overview has them: in at most 600 points."""
    content = await asyncio.to_thread(series_json, archive, run_id, start_s, end_s)
    return Response(content, media_type="application/json")


def overview_json(archive: Archive, run_id: str) -> bytes:
    record = record_of(archive, run_id)
    with opened(archive, run_id) as recording:
        return msgspec.json.encode({"id": record.id, "label": record.label, **overview_of(recording)})


def series_json(archive: Archive, run_id: str, start: float, end: float) -> bytes:
    """start, end: s since the run's start; where there is nothing between them, no columns."""
    record_of(archive, run_id)
    with opened(archive, run_id) as recording:
        return msgspec.json.encode({"series": computed_series(recording, start, end)})


@contextmanager
def opened(archive: Archive, run_id: str) -> Iterator[Recording]:
    """Raises `Rejected` in words, also for what turns out to be unreadable on the way."""
    try:
        with Recording.open(path_of(archive, run_id)) as recording:
            yield recording
    except Unreadable as error:
        raise Rejected(Problem(409, "Unreadable", str(error))) from error
