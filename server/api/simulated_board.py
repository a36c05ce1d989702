"""The printed board in front of the simulated camera, held as a person would who calibrates it."""

from __future__ import annotations

import asyncio
from typing import Any, Literal

from fastapi import APIRouter

from control.safety import Refused
from server.api.access import TheRig
from server.api.body import StrictRoute
from server.api.calibration import TheCalibration
from server.api.operator import TheHand
from server.api.problems import not_found
from server.api.schemas import Edge
from server.calibration.optics import assumed_model, board_of
from server.exchange import require_disarmed
from server.rig import Rig
from server.streams import StreamEnded
from vision.simulated.camera import SyntheticCamera
from vision.simulated.held_board import FLAT, HELD, held_board, shown_board

router = APIRouter(prefix="/simulation/board", tags=["simulation"], route_class=StrictRoute)

PICTURES_ON_THE_WAY = 2
"""One may be in work; the next one is drawn anew."""
SEEN_WITHIN = 3.0
"""So long a picture of the new scene is waited for, s."""


class BoardBody(Edge):
    """flat: in the middle of the plate; next: held another way than before."""

    shown: bool
    pose: Literal["flat", "next"] = "flat"


@router.put("")
async def show_board(
    body: BoardBody, rig: TheRig, calibration: TheCalibration, hand: TheHand
) -> dict[str, Any]:
    """Show the printed board to the simulated camera of a disarmed rig, or take it away, which may be done at any
    time; answers when a picture shows it."""
    camera = rig.machine.camera
    if not isinstance(camera, SyntheticCamera):
        raise not_found("This rig is real; hold the printed board under its camera.")
    if body.shown:
        require_disarmed(rig.snapshot.rig, "what the simulated camera sees")
    hand.require()
    number = calibration.held(body.pose == "next") if body.shown else 0
    await asyncio.to_thread(_show, camera, rig, body, number)
    calibration.board_is_shown(camera, body.pose if body.shown else None)
    await _until_seen(rig)
    return {"shown": body.shown, "pose": body.pose, "number": number, "poses": len(HELD)}


def _show(camera: SyntheticCamera, rig: Rig, body: BoardBody, number: int) -> None:
    if not body.shown:
        camera.show_board(None)
        return
    optics, board = assumed_model(rig.settings.camera), board_of(rig.settings.camera)
    if body.pose == "next":
        camera.show_board(held_board(board, optics, number))
    else:
        camera.show_board(shown_board(board, optics, FLAT))


async def _until_seen(rig: Rig) -> None:
    """Until the newest picture shows what is there now: the first that comes may have been drawn before.

    Raises `Refused` when none comes.
    """
    seen = [rig.frame]
    try:
        async with asyncio.timeout(SEEN_WITHIN), rig.updates.subscribe() as ticks:
            while len(seen) <= PICTURES_ON_THE_WAY:
                await ticks.get()
                if rig.frame is not seen[-1]:
                    seen.append(rig.frame)
    except (TimeoutError, StreamEnded):
        raise Refused("no picture came from the simulated camera; is it unplugged or frozen?") from None
