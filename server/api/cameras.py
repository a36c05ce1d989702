"""The cameras that there are: the rig's own, and what else is plugged in."""

from __future__ import annotations

import asyncio
import contextlib
from typing import Any

from fastapi import APIRouter

from control.parts import Camera
from server.api.access import TheRig
from server.api.body import StrictRoute
from server.api.problems import Problem, Rejected
from vision.sources.addresses import device_of, shown
from vision.sources.listing import FoundCamera
from vision.sources.request import CameraError
from vision.sources.search import CameraSearch

SEARCH_TIME = 3.0
"""The drivers of all cameras may take so long to say what they offer, s."""

search = CameraSearch()
router = APIRouter(tags=["cameras"], route_class=StrictRoute)


@router.get("/cameras")
async def cameras(rig: TheRig) -> list[dict[str, Any]]:
    """The rig's camera first, then every other one of this computer. None that is in use is opened.

    An `identity` tells a camera from others wherever it is plugged in; the `uri` is what camera.uri takes, without
    the login of a network camera. `sizes` and `rates_Hz` are empty where a camera does not tell what it offers.
    """
    found = await _found()
    machine = rig.machine
    return _listed(machine.camera, machine.settings.camera.uri, found)


async def _found() -> list[FoundCamera]:
    try:
        async with asyncio.timeout(SEARCH_TIME):
            return await asyncio.shield(asyncio.wrap_future(search.begin()))
    except TimeoutError:
        detail = f"A camera's driver has not answered for {SEARCH_TIME:g} s: unplug it and plug it in again."
        raise Rejected(Problem(503, "No list of cameras", detail)) from None


def _listed(camera: Camera, uri: str, found: list[FoundCamera]) -> list[dict[str, Any]]:
    path = _path_of(uri)
    own = next((one for one in found if one.path == path), None)
    others = [_camera_json(one) for one in found if one is not own]
    return [_own_json(camera, uri, own), *others]


def _path_of(uri: str) -> str:
    """The device file that the rig's camera is behind, "" for what is none."""
    with contextlib.suppress(CameraError):
        return str(device_of(uri).resolve()) if uri.startswith("v4l:") else ""
    return ""


def _own_json(camera: Camera, uri: str, found: FoundCamera | None) -> dict[str, Any]:
    """The rig's camera is not asked anything: its sizes are the one that it gives."""
    return {
        "uri": shown(uri),
        "name": found.name if found else camera.identity or shown(uri),
        "identity": camera.identity,
        "path": found.path if found else None,
        "in_use": True,
        "sizes": [list(camera.size)],
        "rates_Hz": [camera.rate],
    }


def _camera_json(camera: FoundCamera) -> dict[str, Any]:
    return {
        "uri": camera.uri,
        "name": camera.name,
        "identity": camera.identity,
        "path": camera.path,
        "in_use": camera.in_use,
        "sizes": [list(size) for size in camera.sizes],
        "rates_Hz": list(camera.rates),
    }
