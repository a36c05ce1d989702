"""What the page shows and the next run uses."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Query

from control.gait_settings import GaitSettings
from server.api.access import TheRig
from server.api.body import StrictRoute
from server.api.choices import select, selection_json
from server.api.operator import TheHand
from server.api.schemas import SelectionBody

router = APIRouter(tags=["selection"], route_class=StrictRoute)


@router.get("/selection")
async def selection(rig: TheRig) -> dict[str, Any]:
    return selection_json(rig.selection)


@router.put("/selection")
async def replace(
    body: SelectionBody,
    rig: TheRig,
    hand: TheHand,
    by: Annotated[str | None, Query(max_length=40)] = None,
) -> dict[str, Any]:
    """Choose; parameters that are left out get their defaults. `by` is repeated to everybody who is told of it."""
    selection = select(body)
    hand.require()
    await rig.select(selection, by)
    return selection_json(rig.selection)


@router.get("/gait")
async def gait_schema() -> dict[str, Any]:
    """The JSON schema of the gait's fields, with units, ranges and defaults."""
    return GaitSettings.model_json_schema()
