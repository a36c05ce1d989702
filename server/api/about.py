"""What this installation is: versions, where it keeps things and how much room there is, and what is connected."""

from __future__ import annotations

import asyncio
import platform
import shutil
from datetime import UTC, datetime
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

from fastapi import APIRouter

from server.api.access import TheArchive, TheRig
from server.api.body import StrictRoute
from vision.sources.addresses import shown

if TYPE_CHECKING:
    from pathlib import Path

    from server.rig import Rig

router = APIRouter(tags=["state"], route_class=StrictRoute)

LIBRARIES = {"OpenCV": "opencv-python-headless", "NumPy": "numpy", "SciPy": "scipy", "Viser": "viser"}
STARTED = datetime.now(UTC)
"""When this program began."""


@router.get("/about")
async def about(rig: TheRig, archive: TheArchive) -> dict[str, Any]:
    """Versions, the data folder with its free space, and the board and the camera in use."""
    return {
        "program": {
            "version": version("pivotrig"),
            "python": platform.python_version(),
            "system": f"{platform.system()} {platform.release()}",
            "started_at": STARTED.isoformat(timespec="seconds"),
            "libraries": {name: version(package) for name, package in LIBRARIES.items()},
        },
        "data": await asyncio.to_thread(data_json, archive.folder.parent),
        "camera": camera_json(rig),
        "board": board_json(rig),
    }


def data_json(folder: Path) -> dict[str, Any]:
    """free_bytes, total_bytes: None where the disk does not answer."""
    try:
        disk = shutil.disk_usage(folder)
    except OSError:
        return {"folder": str(folder), "free_bytes": None, "total_bytes": None}
    return {"folder": str(folder), "free_bytes": disk.free, "total_bytes": disk.total}


def camera_json(rig: Rig) -> dict[str, Any]:
    camera = rig.machine.camera
    return {
        "uri": shown(rig.settings.camera.uri),
        "identity": camera.identity,
        "size_px": list(camera.size),
        "rate_Hz": camera.rate,
        "trouble": camera.trouble or "",
    }


def board_json(rig: Rig) -> dict[str, Any]:
    link = rig.snapshot.link
    return {
        "port": link.port,
        "state": str(link.state),
        "firmware": link.firmware,
        "baud": rig.settings.link.baud,
    }
