"""A rig's camera alone, for calibrating it: pictures as they come, and the board in front of a simulated one."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from rich.status import Status

from server.assembly import Machine, build_machine
from server.calibration.optics import assumed_model, board_of
from server.commands.bench import explained
from server.commands.outcome import FAILED, console, fail
from server.settings import RigFile
from vision.calibration.board import BoardFinder, Sighting
from vision.calibration.lens import Lens
from vision.calibration.views import Views, stands_still
from vision.simulated.camera import SyntheticCamera
from vision.simulated.held_board import FLAT, HELD, held_board, shown_board

FRAME_TIMEOUT = 0.1
"""So long one picture is waited for at a time, s."""
PATIENCE = 120.0
"""So long a person may take for the next view, s of rig time."""
PATIENCE_SIMULATED = 2.0
"""A simulated board is moved at once, s."""


@dataclass(slots=True)
class CameraBench:
    """A camera, the board that is looked for, and how often a simulated one has been moved."""

    machine: Machine
    finder: BoardFinder
    moves: int = 0

    @property
    def patience(self) -> float:
        return PATIENCE_SIMULATED if self.machine.camera.simulated else PATIENCE

    def lay_flat(self) -> None:
        """Of a simulated rig; on a real one a person does it."""
        camera = self.machine.camera
        if isinstance(camera, SyntheticCamera):
            optics = assumed_model(self.machine.settings.camera)
            camera.show_board(shown_board(self.finder.board, optics, FLAT))

    def move_on(self) -> None:
        """Hold the board another way, where the rig is simulated."""
        camera = self.machine.camera
        if isinstance(camera, SyntheticCamera):
            optics = assumed_model(self.machine.settings.camera)
            camera.show_board(held_board(self.finder.board, optics, self.moves))
            self.moves += 1

    @property
    def has_shown_all(self) -> bool:
        """A simulated board has been held in every way there is."""
        return self.moves > len(HELD)

    def looks(self) -> Iterator[Sighting | None]:
        """The board in one picture after the other, None where it is not seen or there is no picture."""
        while True:
            frame = self.machine.camera.read(FRAME_TIMEOUT)
            yield None if frame is None else self.finder.find(frame.image)

    def still_board(self) -> Sighting:
        """The board once it stands still; ends the command when it is not seen in time."""
        begin, last = self.machine.camera.now(), None
        for sighting in self.looks():
            if sighting is not None and stands_still(last, sighting):
                return sighting
            last = sighting
            if self.machine.camera.now() - begin > self.patience:
                break
        board = self.finder.board
        raise fail(
            f"the printed board ({board.columns} x {board.rows} squares) is not seen: lay it flat under the camera, "
            "light it evenly; is it the one that [camera.board] describes?",
            FAILED,
        )

    def gather(self, status: Status) -> Views:
        """Views for the lens, taken whenever the board stands still; ends the command when none comes in time."""
        views = Views(Lens.of(assumed_model(self.machine.settings.camera)))
        taken_at, last = self.machine.camera.now(), None
        self.move_on()
        for sighting in self.looks():
            still = sighting is not None and stands_still(last, sighting)
            refused = views.offer(sighting) if still and sighting is not None else "not seen yet"
            if still:
                self.move_on()
            if not refused:
                taken_at = self.machine.camera.now()
            if views.is_enough or self.has_shown_all:
                return views
            if self.machine.camera.now() - taken_at > self.patience:
                raise fail(f"no new view for {self.patience:g} s; {views.hint}", FAILED)
            status.update(_progress(views, sighting))
            last = sighting
        return views


def _progress(views: Views, sighting: Sighting | None) -> str:
    seen = "the board is not seen" if sighting is None else f"{len(sighting.pixels)} corners"
    return f"{len(views.taken)} views, {views.coverage:.0%} of the picture, {seen}: {views.hint}"


@contextmanager
def opened_camera(rig_file: RigFile) -> Iterator[CameraBench]:
    """The rig's camera, open; nothing is sent to its board."""
    with explained():
        machine = build_machine(rig_file, realtime=not rig_file.is_simulated)
        try:
            machine.camera.require()
            yield CameraBench(machine, BoardFinder(board_of(rig_file.camera)))
        finally:
            machine.close()


@contextmanager
def watching(words: str) -> Iterator[Status]:
    with console.status(words) as status:
        yield status
