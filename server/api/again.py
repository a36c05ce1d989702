"""A run that was recorded, once more on the rig."""

from __future__ import annotations

import asyncio
from typing import Annotated, Any

from fastapi import APIRouter
from pydantic import Field

from server.api.access import TheArchive, TheRig
from server.api.body import StrictRoute
from server.api.operator import TheHand
from server.api.recorded import record_of
from server.api.runs import run_json
from server.replay.again import Difference, differences, request_again, restore_path
from server.replay.then import recorded_rig

router = APIRouter(tags=["runs"], route_class=StrictRoute)


@router.post("/runs/{run_id}/again", status_code=201)
async def again(
    run_id: Annotated[str, Field(max_length=80)], rig: TheRig, archive: TheArchive, hand: TheHand
) -> dict[str, Any]:
    """Start what was asked for then; `differences` says what of the rig file has changed since."""
    record = await asyncio.to_thread(record_of, archive, run_id)
    restore_path(record.settings, rig.custom_trajectories)
    await rig.custom_trajectories.keep()
    run = await rig.start_run(request_again(record), hand.require)
    changed = differences(recorded_rig(record.settings), recorded_rig({"rig": rig.settings.to_recorded()}))
    return {"run": run_json(run), "differences": [difference_json(each) for each in changed]}


def difference_json(difference: Difference) -> dict[str, Any]:
    return {
        "name": difference.name,
        "then": difference.then,
        "now": difference.now,
        "words": difference.words,
    }
