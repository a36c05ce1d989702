"""The parts at a rig's seams: as they are, or with the fault points of a simulated rig in front of them."""

from __future__ import annotations

from collections.abc import Callable

from control.controllers import Law
from control.link.conversion import Configuration
from control.link.port import Link
from control.loop import ControlLoop
from control.perception import Tracker
from control.simulation.disk_faults import DiskFaults
from control.simulation.faults.injection import Faults
from control.simulation.faults.parts import FaultyController, FaultyLink, FaultyTracker
from control.simulation.faults.points import Decisions, FaultPoints, Nominal, Reports, Sighting
from control.simulation.line_faults import LineFaults
from control.simulation.world import World
from server.faulty_disk import FaultyDisk
from server.recording.writing.disk import Disk, LocalDisk
from server.settings import RigFile
from vision.simulated.camera import SyntheticCamera

Clock = Callable[[], float]


class Seams:
    """A real rig's: nothing is in front of anything."""

    def link(self, port: str, baud: int, configuration: Configuration, clock: Clock) -> Link:
        return Link(port, baud, configuration, clock)

    def tracker(self, tracker: Tracker) -> Tracker:
        return tracker

    def controller(self, controller: Law) -> Law:
        return controller

    def disk(self) -> Disk:
        """Where recordings go."""
        return LocalDisk()

    def faults(self, clock: Clock, loop: ControlLoop) -> Faults | None:  # noqa: ARG002 (the other seams need them)
        """What can be injected, None on a real rig."""
        return None


class FaultySeams(Seams):
    """A simulated rig's: everything can fail on demand."""

    def __init__(self, settings: RigFile, world: World, camera: SyntheticCamera) -> None:
        self._settings = settings
        self._world = world
        self._camera = camera
        self.line = LineFaults(camera.now, settings.simulation.seed)
        self._sighting = Sighting()
        self._reports = Reports()
        self._decisions = Decisions()
        self._disk = DiskFaults(camera.now)

    def link(self, port: str, baud: int, configuration: Configuration, clock: Clock) -> Link:
        link = FaultyLink(port, baud, configuration, clock, self.line.wrap)
        link.reports = self._reports
        return link

    def tracker(self, tracker: Tracker) -> Tracker:
        return FaultyTracker(tracker, self._sighting)

    def controller(self, controller: Law) -> Law:
        return FaultyController(controller, self._decisions, self._camera.pass_time)

    def disk(self) -> Disk:
        return FaultyDisk(LocalDisk(), self._disk)

    def faults(self, clock: Clock, loop: ControlLoop) -> Faults:
        points = FaultPoints(
            camera=self._camera,
            line=self.line,
            board=self._world.board,
            robot=self._world,
            coils=loop,
            nominal=_nominal(self._settings),
            sighting=self._sighting,
            reports=self._reports,
            decisions=self._decisions,
            disk=self._disk,
        )
        faults = Faults(points, clock, loop.announce)
        self._world.attend(faults.attend)
        return faults


def _nominal(settings: RigFile) -> Nominal:
    coils = settings.coils
    x, y, z = (round(coil.resistance_ohm * 1e3) for coil in (coils.x, coils.y, coils.z))
    return Nominal(round(coils.supply_V * 1e3), (x, y, z))
