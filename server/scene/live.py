"""The rig as it is now, for the scene."""

from __future__ import annotations

from typing import TYPE_CHECKING

from control.snapshot import Snapshot
from server.scene.geometry import geometry_of
from server.scene.plate_pictures import Photograph
from server.scene.robot import ShownRobot
from server.scene.scene import View
from server.scene.shapes import full_field

if TYPE_CHECKING:
    from server.rig import Rig

PATH_EVERY = 10
"""The path is asked for at each tenth view: it is worked out point by point and seldom changes."""


class LiveView:
    """What the scene shows of a snapshot; made anew where the rig's settings have changed."""

    def __init__(self, rig: Rig) -> None:
        self._rig = rig
        self._renew()

    def _renew(self) -> None:
        self._settings = self._rig.settings
        self._camera = self._rig.machine.camera_model
        self.geometry = geometry_of(self._settings, self._rig.coils, self._camera)
        self._views = 0

    def view(self, snapshot: Snapshot) -> View:
        if self._settings is not self._rig.settings or self._camera is not self._rig.machine.camera_model:
            self._renew()
        if self._views % PATH_EVERY == 0:
            self._path = self._rig.reference_points()
        self._views += 1
        robot = ShownRobot(
            snapshot.pose,
            snapshot.command.pivot,
            snapshot.body_tilt,
            self._path,
            self._rig.trail(),
            snapshot.reference,
        )
        return View(self.geometry, snapshot.currents, (robot,), full_field(self._rig.walked.gait.field))

    def photograph(self) -> Photograph | None:
        frame = self._rig.frame
        return None if frame is None else Photograph(frame.image, frame.index)
