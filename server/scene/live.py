"""The rig as it is now, for the scene."""

from __future__ import annotations

from typing import TYPE_CHECKING

from control.snapshot import Snapshot
from server.scene.geometry import geometry_of
from server.scene.robot import ShownRobot
from server.scene.scene import View

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
        self.geometry = geometry_of(self._settings, self._rig.coils)
        self._views = 0

    def view(self, snapshot: Snapshot) -> View:
        if self._settings is not self._rig.settings:
            self._renew()
        if self._views % PATH_EVERY == 0:
            self._path = self._rig.reference_points()
        self._views += 1
        robot = ShownRobot(
            snapshot.pose, snapshot.command.pivot, snapshot.body_tilt, self._path, self._rig.trail()
        )
        return View(self.geometry, snapshot.currents, (robot,))
