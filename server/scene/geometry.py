"""What of a rig the 3D scene draws to scale."""

from __future__ import annotations

from dataclasses import dataclass

from control.coils import CoilSet
from server.settings import MM, RigFile
from vision.camera_model import CameraModel

CM = 100.0
"""Scene units per metre: Viser's near plane and lights suit lengths of 1 to 100."""


@dataclass(frozen=True, slots=True)
class RobotSize:
    """Lengths in m. length: between the pivots.  width, height: of the body."""

    length: float
    width: float
    height: float


@dataclass(frozen=True, slots=True)
class SceneGeometry:
    """workspace: half the square's side, m.  camera: where it stands and how it sees, None while that is unknown."""

    coils: CoilSet
    workspace: float
    robot: RobotSize
    camera: CameraModel | None = None


def geometry_of(settings: RigFile, coils: CoilSet, camera: CameraModel | None = None) -> SceneGeometry:
    robot = settings.robot
    size = RobotSize(robot.length_mm * MM, robot.body_width_mm * MM, robot.body_height_mm * MM)
    return SceneGeometry(coils, coils.workspace, size, camera)
