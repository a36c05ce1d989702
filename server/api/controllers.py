"""The controllers there are."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter

from control.controllers import controllers
from server.api.body import StrictRoute
from server.api.choices import listing

router = APIRouter(tags=["controllers"], route_class=StrictRoute)


@router.get("/controllers")
async def list_controllers() -> list[dict[str, Any]]:
    """Each with the JSON schema of its parameters."""
    return listing(controllers)
