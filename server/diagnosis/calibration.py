"""Whether lens and plane of the camera are calibrated, how well, and whether they are this camera's."""

from __future__ import annotations

from collections.abc import Iterator

from server.calibration.optics import misfit
from server.camera_sections import CameraSection, LensSection, PlaneSection
from server.diagnosis.check import Check, info, ok, problem, warning
from server.settings import RigFile

LENS, PLANE = "lens", "plane"
COMMANDS = {LENS: "print `pivotrig calibrate board`, then run `pivotrig calibrate lens --save`",
            PLANE: "run `pivotrig calibrate plane --save`"}  # fmt: skip


def examine(settings: RigFile, identity: str) -> Iterator[Check]:
    """identity: of the camera that is open."""
    camera = settings.camera
    for name, section in ((LENS, camera.lens), (PLANE, camera.plane)):
        if section is None:
            yield _not_calibrated(name, settings)
        else:
            yield _calibrated(name, section, camera, identity)


def _not_calibrated(name: str, settings: RigFile) -> Check:
    """A simulated camera is what the rig file assumes."""
    finding = "not calibrated: as the rig file assumes"
    if settings.is_simulated:
        return info(name, finding)
    return warning(name, f"{finding}, so that positions may be millimetres off", COMMANDS[name])


def _calibrated(
    name: str, section: LensSection | PlaneSection, camera: CameraSection, identity: str
) -> Check:
    why_not = misfit(camera, section, identity)
    if why_not:
        reason, _, _ = why_not.rpartition(": ")
        return problem(name, f"calibrated for {reason}; the rig does not arm", COMMANDS[name])
    return ok(name, f"calibrated {section.date}: {_quality(section)}")


def _quality(section: LensSection | PlaneSection) -> str:
    if isinstance(section, LensSection):
        return f"{section.views} views, residual {section.residual_px:.3f} px"
    return f"from {section.source}, positions known to {section.residual_mm:.3f} mm"
