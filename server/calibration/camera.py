"""One calibration of the camera at a time: the views gathered, what was solved of them, and what is saved of that.

It belongs to the application, not to the machine, which each saved calibration rebuilds. What it holds is for one
camera, one size of picture and one printed board; with another of these it begins anew.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeVar

from control.model import Frame
from control.safety import Refused
from server.calibration.optics import assumed_model, board_of, lens_in_use, lens_section, plane_section, today
from server.camera_sections import BoardSection, CameraSection
from server.settings import MM
from server.streams import StreamEnded
from vision.calibration.board import BoardFinder, Sighting
from vision.calibration.lens import Lens, LensFit, solve_lens
from vision.calibration.plane import PlaneFit, plane_from_board
from vision.calibration.views import Views, stands_still
from vision.camera_model import CalibrationError

if TYPE_CHECKING:
    from server.rig import Rig

T = TypeVar("T")

OLDEST_PICTURE = 1.0
"""A picture of longer ago, s, is not what is in front of the camera."""
MOVED = "the board moved: hold it still for a moment"


class NoBoard(CalibrationError):
    """The board is not in the picture; the text says what to do."""


@dataclass(frozen=True, slots=True)
class Subject:
    """What is calibrated. assumed: its lens until then."""

    identity: str
    assumed: Lens
    board: BoardSection


@dataclass(frozen=True, slots=True)
class Look:
    """What one picture of the board brought. refused: why it was not taken as a view, "" if it was."""

    sighting: Sighting
    refused: str


class CameraCalibration:
    """Views of the printed board, and lens and plane that were found but are not saved yet.

    What takes long is done off the event loop, one thing after the other, however many ask.
    """

    def __init__(self, rig: Rig) -> None:
        self._rig = rig
        self._one_at_a_time = asyncio.Lock()
        self._subject: Subject | None = None
        self.views: Views
        self.lens: LensFit | None = None
        self.plane: PlaneFit | None = None
        self._lens_date = ""
        self._held = 0
        self._shown: tuple[object, str] | None = None
        """The simulated camera that was shown the board, and how."""
        self.renew()

    # What it is about --------------------------------------------------------------------------------

    @property
    def settings(self) -> CameraSection:
        return self._rig.settings.camera

    @property
    def identity(self) -> str:
        """Of the camera; of the one before as long as the rig has been without one since."""
        before = "" if self._subject is None else self._subject.identity
        return self._rig.machine.camera.identity or before

    @property
    def workspace(self) -> float:
        """Half the side of the workspace, m."""
        return 0.5 * self._rig.settings.limits.workspace_mm * MM

    def renew(self) -> None:
        """Begin anew if the camera, its pictures' size or the board are others than before."""
        settings = self.settings
        subject = Subject(self.identity, Lens.of(assumed_model(settings)), settings.board)
        if subject != self._subject:
            self._subject = subject
            self._finder = BoardFinder(board_of(settings))
            self.forget_views()
            self.lens = self.plane = None

    def frame(self) -> Frame:
        """The newest picture; raises `Refused` when there is none of now."""
        frame = self._rig.frame
        if frame is None or not self._rig.machine.camera.now() - frame.captured_at <= OLDEST_PICTURE:
            raise Refused("there is no picture from the camera; see that it is connected")
        return frame

    async def _another_frame(self, than: Frame) -> Frame:
        """The one that comes next; raises `Refused` when none does."""
        try:
            async with asyncio.timeout(OLDEST_PICTURE), self._rig.updates.subscribe() as ticks:
                while (frame := self.frame()) is than:
                    await ticks.get()
        except (TimeoutError, StreamEnded):
            raise Refused("there is no new picture from the camera; see that it is connected") from None
        return frame

    async def _worked(self, work: Callable[[], T]) -> T:
        """Done on a thread of its own; raises `Refused` when it was about another camera than there is now."""
        async with self._one_at_a_time:
            self.renew()
            subject = self._subject
            result = await asyncio.to_thread(work)
            self.renew()
            if self._subject is not subject:
                raise Refused("the camera, its pictures or the board have changed meanwhile: begin anew")
            return result

    # The board before a simulated camera ----------------------------------------------------------------

    def held(self, another: bool) -> int:
        """How many times the simulated board was held another way."""
        if another:
            self._held += 1
        return self._held

    def board_is_shown(self, camera: object, pose: str | None) -> None:
        """To a camera, "flat" or in the "next" way; None: not any more."""
        self._shown = None if pose is None else (camera, pose)

    @property
    def shown_board(self) -> str | None:
        """How the board is shown; a camera that was rebuilt has never seen it."""
        if self._shown is not None and self._shown[0] is not self._rig.machine.camera:
            self._shown = None
        return None if self._shown is None else self._shown[1]

    # Views and lens ----------------------------------------------------------------------------------

    def sight(self, frame: Frame) -> Sighting:
        """The board in a picture; raises `NoBoard`."""
        sighting = self._finder.find(frame.image)
        if sighting is None:
            board = self._finder.board
            raise NoBoard(
                f"the printed board ({board.columns} x {board.rows} squares) is not seen: bring more of it into the "
                "picture, light it evenly, keep it flat and still; is it the board that the rig file describes?"
            )
        return sighting

    async def _still_board(self) -> tuple[Sighting, bool]:
        """The board in two pictures one after the other: where it is now, and whether it stood still."""
        before = self.frame()
        after = await self._another_frame(before)
        one, other = await self._worked(lambda: (self.sight(before), self.sight(after)))
        return other, stands_still(one, other)

    async def look(self) -> Look:
        """Take a view of the board if it stands still and brings something new; raises `NoBoard`."""
        sighting, still = await self._still_board()
        return Look(sighting, self.views.offer(sighting) if still else MOVED)

    def forget_views(self) -> None:
        self.views = Views(Lens.of(assumed_model(self.settings)))

    async def solve_lens(self) -> LensFit:
        """The lens from the views; a plane that was found with another one is dropped. Raises CalibrationError."""
        self.lens = await self._worked(lambda: solve_lens(tuple(self.views.taken)))
        self.plane, self._lens_date = None, today()
        return self.lens

    # Plane -------------------------------------------------------------------------------------------

    @property
    def lens_at_hand(self) -> Lens:
        """The one found just now, else the saved one, else the assumed one."""
        return self.lens.lens if self.lens is not None else lens_in_use(self.settings)

    @property
    def lens_source(self) -> str:
        """Which of the three that is: "new", "saved" or "assumed"."""
        if self.lens is not None:
            return "new"
        saved = self.settings.lens
        return "saved" if saved is not None and saved.size_px == self.settings.size_px else "assumed"

    async def solve_plane(self, solve: Callable[[Lens, float], PlaneFit]) -> PlaneFit:
        """solve: of the lens and the workspace's half side, m. Raises CalibrationError."""
        plane = await self._worked(lambda: solve(self.lens_at_hand, self.workspace))
        if plane.lens != self.lens_at_hand:
            raise Refused("another lens was found or saved meanwhile: work the plane out again")
        self.plane = plane
        return plane

    async def plane_of_board(self) -> PlaneFit:
        """From the board lying flat; raises `NoBoard` and CalibrationError."""
        sighting, still = await self._still_board()
        if not still:
            raise CalibrationError(MOVED)
        thickness = self.settings.board.thickness_mm * MM
        return await self.solve_plane(
            lambda lens, workspace: plane_from_board(lens, sighting, workspace, thickness)
        )

    # Saving ------------------------------------------------------------------------------------------

    def changes(self) -> Mapping[str, Any]:
        """Of the rig file, to save what was found; raises `Refused` when nothing was.

        A new lens without a new plane takes the old plane out, which belongs to the old lens.
        """
        if self.lens is None and self.plane is None:
            raise Refused("there is nothing to save: solve the lens or the plane first")
        return {"camera": {**self._lens_changes(), **self._plane_changes()}}

    def _lens_changes(self) -> dict[str, Any]:
        if self.lens is None:
            return {}
        return {"lens": lens_section(self.lens, self.identity, self._lens_date), "plane": None}

    def _plane_changes(self) -> dict[str, Any]:
        if self.plane is None:
            return {}
        saved = self.settings.lens
        assumed_or_saved = saved.date if self.lens_source == "saved" and saved is not None else ""
        date = self._lens_date if self.lens is not None else assumed_or_saved
        return {"plane": plane_section(self.plane, self.identity, today(), date)}

    def saved(self, lens: LensFit | None, plane: PlaneFit | None) -> None:
        """These are in the rig file now; what was found since is not."""
        self.lens = None if self.lens is lens else self.lens
        self.plane = None if self.plane is plane else self.plane

    def forget(self) -> None:
        """Drop everything that is not saved."""
        self.forget_views()
        self.lens = self.plane = None
