"""What the calibration's routes answer, in the lab's units."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from server.calibration.camera import CameraCalibration, Look
from server.calibration.optics import board_of, height_and_tilt, lens_figures, misfit, model_in_use, scale
from server.settings import MM
from vision.calibration.lens import LensFit
from vision.calibration.plane import PlaneFit

OUTLINE_STEPS = 12
"""Points along each side of the workspace's outline in the picture, where a lens bends it."""


def state_json(calibration: CameraCalibration) -> dict[str, Any]:
    """Saved, in work, and the board."""
    return {
        "camera": {"identity": calibration.identity, "size_px": list(calibration.settings.size_px)},
        "lens": _lens(calibration),
        "plane": _plane(calibration),
        "session": session_json(calibration),
        "board": board_json(calibration),
    }


def _lens(calibration: CameraCalibration) -> dict[str, Any] | None:
    section = calibration.settings.lens
    if section is None:
        return None
    why_not = misfit(calibration.settings, section, calibration.identity)
    return {**section.model_dump(mode="json"), **_fits(why_not)}


def _plane(calibration: CameraCalibration) -> dict[str, Any] | None:
    section = calibration.settings.plane
    if section is None:
        return None
    why_not = misfit(calibration.settings, section, calibration.identity)
    height, tilt = height_and_tilt(model_in_use(calibration.settings))
    return {
        **section.model_dump(mode="json"),
        "height_mm": round(height, 2),
        "tilt_deg": round(tilt, 3),
        **_fits(why_not),
    }


def _fits(why_not: str) -> dict[str, Any]:
    return {"fits": not why_not, "why_not": f"it was made for {why_not}" if why_not else ""}


def session_json(calibration: CameraCalibration) -> dict[str, Any]:
    """What has been gathered and found, and is not saved."""
    lens, plane = calibration.lens, calibration.plane
    return {
        "views": len(calibration.views.taken),
        "coverage": round(calibration.views.coverage, 3),
        "covered_px": _corners(calibration),
        "enough": calibration.views.is_enough,
        "hint": calibration.views.hint,
        "board_shown": calibration.shown_board,
        "pending_lens": None if lens is None else pending_lens_json(lens),
        "pending_plane": None if plane is None else pending_plane_json(calibration, plane),
    }


def _corners(calibration: CameraCalibration) -> list[list[float]]:
    """Every corner of every view, for a map of what has been covered, px."""
    seen = [view.pixels for view in calibration.views.taken]
    return np.round(np.vstack(seen), 1).tolist() if seen else []


def board_json(calibration: CameraCalibration) -> dict[str, Any]:
    board, section = board_of(calibration.settings), calibration.settings.board
    return {
        "columns": board.columns,
        "rows": board.rows,
        "square_mm": section.square_mm,
        "marker_mm": round(board.marker / MM, 3),
        "dictionary": board.dictionary,
        "thickness_mm": section.thickness_mm,
    }


def looked_json(calibration: CameraCalibration, look: Look) -> dict[str, Any]:
    """taken: whether the picture became a view; why_not: else, what to do."""
    return {
        "taken": not look.refused,
        "why_not": look.refused,
        "views": len(calibration.views.taken),
        "coverage": round(calibration.views.coverage, 3),
        "enough": calibration.views.is_enough,
        "hint": look.refused or calibration.views.hint,
        "corners": len(look.sighting.pixels),
        "corners_px": np.round(look.sighting.pixels, 2).tolist(),
    }


def pending_lens_json(fit: LensFit) -> dict[str, Any]:
    return {**lens_figures(fit), "dropped": list(fit.dropped)}


def pending_plane_json(calibration: CameraCalibration, fit: PlaneFit) -> dict[str, Any]:
    return {**plane_json(fit, calibration.workspace), "identity": calibration.identity, "lens": calibration.lens_source,
            "remarks": _remarks(calibration, fit)}  # fmt: skip


def _remarks(calibration: CameraCalibration, fit: PlaneFit) -> list[str]:
    """What else the operator should know of it."""
    if calibration.lens_source != "assumed":
        return list(fit.remarks)
    assumed = (
        "the lens is not calibrated, so that it is as the rig file assumes: positions may be further off"
    )
    return [*fit.remarks, assumed]


def plane_json(fit: PlaneFit, workspace: float) -> dict[str, Any]:
    """workspace: half the side of the square whose outline is drawn, m."""
    model = fit.model
    return {
        "source": fit.source.value,
        "residual_mm": round(fit.residual / MM, 5),
        "residual_px": round(fit.residual_picture, 4),
        "scale_px_mm": round(scale(model), 5),
        "height_mm": round(fit.camera_height / MM, 2),
        "tilt_deg": round(math.degrees(fit.tilt), 3),
        "size_px": list(model.size),
        "outline_px": np.round(model.to_image(_outline(workspace)), 2).tolist(),
    }


def _outline(half: float) -> np.ndarray:
    """(n, 2) points round the workspace, m, from its upper left corner clockwise."""
    along = np.linspace(-half, half, OUTLINE_STEPS, endpoint=False)
    side = np.full(OUTLINE_STEPS, half)
    return np.vstack(
        [
            np.column_stack([along, side]),
            np.column_stack([side, -along]),
            np.column_stack([-along, -side]),
            np.column_stack([-side, along]),
        ]
    )
