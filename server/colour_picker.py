"""Clicks into the newest picture: what is there, as thresholds that would find it."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from control.safety import Refused
from server.settings import MM
from vision.tracking.picking import Part, Proposal, Sight, pick

if TYPE_CHECKING:
    from server.rig import Rig


class NoPicture(Refused):
    """The camera has delivered nothing yet."""


class ColourPicker:
    """Looks at one click at a time: however many there are, they cost the control loop one core at most."""

    def __init__(self, rig: Rig) -> None:
        self._rig = rig
        self._looks = False

    async def pick(self, place: tuple[float, float], part: Part) -> Proposal:
        """What is at a place (u, v), px; raises `Refused`, and `PickError` where there is nothing to be found."""
        if self._looks:
            raise Refused("another click is being looked at; click again in a moment")
        sight = sight_of(self._rig)
        self._looks = True
        work = asyncio.get_running_loop().run_in_executor(None, pick, sight, place, part)
        work.add_done_callback(self._done)
        return await asyncio.shield(work)

    def _done(self, work: asyncio.Future[Proposal]) -> None:
        self._looks = False
        work.exception()  # nobody may be left to hear of it


def sight_of(rig: Rig) -> Sight:
    """The newest picture with what is needed to measure in it; raises `Refused` for one of another size."""
    frame, machine = rig.frame, rig.machine
    width, height = machine.camera_model.size
    if frame is None:
        raise NoPicture("the camera has not delivered a frame")
    if frame.image.shape != (height, width, 3):
        raise Refused(f"the camera's picture is not {width}x{height} px in colour, as its calibration is")
    length = rig.settings.robot.body_length_mm * MM
    return Sight(frame.image, machine.camera_model, machine.body_height, length)
