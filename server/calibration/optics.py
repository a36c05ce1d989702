"""The camera's optics as the rig file has them: calibrated where that fits this camera, else assumed.

In a simulated rig the assumed optics are the true ones, through which the picture is drawn.
"""

from __future__ import annotations

import math
from datetime import datetime
from typing import Any

import numpy as np

from server.camera_sections import CameraSection, LensSection, PlaneSection
from server.settings import MM
from vision.calibration.board import Board
from vision.calibration.lens import Lens, LensFit
from vision.calibration.plane import PlaneFit, camera_model
from vision.camera_model import CameraModel

SAME_FOCAL = 0.01
"""Two focal lengths closer than this, px, are the same: they are rounded in the file."""


def assumed_model(camera: CameraSection) -> CameraModel:
    """A camera that hangs where the rig file says, its lens as the rig file says."""
    return CameraModel.looking_down(
        size=camera.size_px,
        height=camera.height_mm * MM,
        picture_height=camera.picture_height_mm * MM,
        tilt=(math.radians(camera.tilt_deg[0]), math.radians(camera.tilt_deg[1])),
        distortion=camera.distortion,
    )


def lens_in_use(camera: CameraSection) -> Lens:
    """The calibrated lens, if it holds for this size; else the assumed one."""
    section = camera.lens
    if section is None or section.size_px != camera.size_px:
        return Lens.of(assumed_model(camera))
    return Lens(
        section.size_px,
        section.fx,
        section.fy,
        section.cx,
        section.cy,
        section.distortion,
        section.error_px,
    )


def model_in_use(camera: CameraSection) -> CameraModel:
    """What the tracker measures with. A calibrated lens without a plane hangs so high that the scale stays."""
    lens, assumed = lens_in_use(camera), assumed_model(camera)
    plane = camera.plane
    if plane is None and lens == Lens.of(assumed):
        return assumed
    if plane is not None and not _plane_misfit(camera, plane):
        x, y, z = (value * MM for value in plane.translation_mm)
        a, b, c = (math.radians(value) for value in plane.rotation_deg)
        return camera_model(lens, (a, b, c), (x, y, z))
    height = assumed.translation[2] * lens.fx / assumed.fx
    return CameraModel(
        lens.size, lens.fx, lens.fy, lens.cx, lens.cy, lens.distortion, assumed.rotation, (0.0, 0.0, height)
    )


def is_calibrated(camera: CameraSection) -> bool:
    """Whether the plate's place in the picture was measured; else a camera that looks straight down is assumed."""
    return camera.plane is not None and not _plane_misfit(camera, camera.plane)


def board_of(camera: CameraSection) -> Board:
    """The board that is printed for this rig."""
    board = camera.board
    return Board(board.columns, board.rows, board.square_mm * MM)


# Whether it fits ------------------------------------------------------------------------------------


def calibration_problem(camera: CameraSection, identity: str) -> str:
    """Why the saved calibration is not this camera's; "" when it is, or when there is none.

    identity: of the camera that is open, "" before it is.
    """
    for name, section in (("lens", camera.lens), ("plane", camera.plane)):
        reason = "" if section is None else misfit(camera, section, identity)
        if reason:
            return f"the camera's {name} was calibrated for {reason}"
    return ""


def misfit(camera: CameraSection, section: LensSection | PlaneSection, identity: str) -> str:
    """Why a calibration does not hold for this camera, as "another thing: what to do"; "" when it does."""
    what_to_do = "calibrate this camera, or take the calibration out"
    if identity and section.identity != identity:
        return f'another camera, "{section.identity}", and this one is "{identity}": {what_to_do}'
    if section.size_px != camera.size_px:
        return f"pictures of {_size(section.size_px)} px, and these have {_size(camera.size_px)} px: {what_to_do}"
    return _plane_misfit(camera, section) if isinstance(section, PlaneSection) else ""


def _plane_misfit(camera: CameraSection, plane: PlaneSection) -> str:
    lens = lens_in_use(camera)
    date = camera.lens.date if camera.lens is not None else ""
    if plane.size_px == lens.size and plane.lens_date == date and abs(plane.focal_px - lens.fx) <= SAME_FOCAL:
        return ""
    return "another lens than the one in use: calibrate the plane again"


def _size(size: tuple[int, int]) -> str:
    return f"{size[0]} x {size[1]}"


# What is saved --------------------------------------------------------------------------------------


def today() -> str:
    """Local date and time, to the second: it also tells one calibration of a lens from the next."""
    return datetime.now().isoformat(sep=" ", timespec="seconds")


def lens_section(fit: LensFit, identity: str, date: str) -> dict[str, Any]:
    """A lens for the rig file."""
    return {"identity": identity, "date": date, **lens_figures(fit)}


def lens_figures(fit: LensFit) -> dict[str, Any]:
    """What was found of a lens, as the rig file and the page have it."""
    lens = fit.lens
    return {
        "size_px": list(lens.size),
        "fx": round(lens.fx, 4),
        "fy": round(lens.fy, 4),
        "cx": round(lens.cx, 4),
        "cy": round(lens.cy, 4),
        "distortion": [round(value, 7) for value in lens.distortion],
        "residual_px": round(fit.residual, 4),
        "error_px": round(lens.error, 5),
        "views": fit.views,
    }


def plane_section(fit: PlaneFit, identity: str, date: str, lens_date: str) -> dict[str, Any]:
    """A plane for the rig file. lens_date: of the lens it was found with, "" for the assumed one."""
    return {
        "source": fit.source.value,
        "identity": identity,
        "date": date,
        "size_px": list(fit.lens.size),
        "lens_date": lens_date,
        "focal_px": round(fit.lens.fx, 4),
        "rotation_deg": [round(math.degrees(value), 6) for value in fit.rotation],
        "translation_mm": [round(value / MM, 5) for value in fit.translation],
        "residual_mm": round(fit.residual / MM, 5),
        "residual_px": round(fit.residual_picture, 4),
        "scale_px_mm": round(scale(fit.model), 5),
    }


def scale(model: CameraModel) -> float:
    """In the middle of the workspace, px/mm."""
    return model.scale_at(0.0, 0.0) * MM


def height_and_tilt(model: CameraModel) -> tuple[float, float]:
    """Of the lens above the plate, mm, and of the camera against looking straight down, degrees."""
    rotation = np.array(model.rotation)
    height = float((-rotation.T @ np.array(model.translation))[2]) / MM
    return height, math.degrees(math.acos(max(-1.0, min(1.0, -model.rotation[2][2]))))
