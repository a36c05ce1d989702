"""`pivotrig calibrate plane`: where the camera is over the plate."""

from __future__ import annotations

import math
from collections.abc import Callable
from enum import StrEnum
from typing import TYPE_CHECKING, Annotated, Any

import typer

from server.camera_sections import CameraSection
from server.commands.bench import JsonOption, SaveOption
from server.commands.calibration_result import saved_or_shown, show
from server.commands.outcome import USAGE, RigOption, fail, read_rig_file
from server.settings import MM, RigFile

if TYPE_CHECKING:
    from server.commands.camera_bench import CameraBench
    from vision.calibration.lens import Lens
    from vision.calibration.plane import PlaneFit

    Solve = Callable[[CameraBench, Lens, float], PlaneFit]
    """Of the camera, its lens and the workspace's half side, m."""


class Method(StrEnum):
    """What the plane is found from."""

    BOARD = "board"
    CORNERS = "corners"
    MARKS = "marks"


def plane(
    method: Annotated[Method, typer.Option(help="What it is found from.")] = Method.BOARD,
    corner: Annotated[
        list[str] | None, typer.Option(help="U,V in px; four times, clockwise from the upper left one.")
    ] = None,
    width: Annotated[float | None, typer.Option("--width-mm", help="Of the rectangle.")] = None,
    height: Annotated[float | None, typer.Option("--height-mm", help="Of the rectangle.")] = None,
    mark: Annotated[
        list[str] | None, typer.Option(help="U,V,X,Y: seen at (u, v) px, known at (x, y) mm; at least four.")
    ] = None,
    thickness: Annotated[
        float | None, typer.Option("--thickness-mm", min=0.0, max=50.0, help="The print above the plate.")
    ] = None,
    save: SaveOption = False,
    rig: RigOption = None,
    as_json: JsonOption = False,
) -> None:
    """Find the plate: from the board lying flat, from a rectangle's corners, or from known marks."""
    rig_file = read_rig_file(rig)
    match method:
        case Method.CORNERS:
            solve = _from_corners(corner, width, height)
        case Method.MARKS:
            solve = _from_marks(mark)
        case Method.BOARD:
            above = rig_file.camera.board.thickness_mm if thickness is None else thickness
            solve = _from_board(above * MM)
    fit, identity = _solved(rig_file, solve)
    result, changes = _result(rig_file, fit, identity)
    show(result, _words(fit, rig_file.camera), saved_or_shown(rig, changes, save), as_json)


def _solved(rig_file: RigFile, solve: Solve) -> tuple[PlaneFit, str]:
    """The plane, and whose it is."""
    from server.calibration.optics import lens_in_use
    from server.commands.camera_bench import opened_camera, watching

    workspace = 0.5 * rig_file.limits.workspace_mm * MM
    with opened_camera(rig_file) as bench, watching("looking at the plate"):
        return solve(bench, lens_in_use(rig_file.camera), workspace), bench.machine.camera.identity


def _from_board(thickness: float) -> Solve:
    from vision.calibration.plane import plane_from_board

    def solve(bench: CameraBench, lens: Lens, workspace: float) -> PlaneFit:
        bench.lay_flat()
        return plane_from_board(lens, bench.still_board(), workspace, thickness)

    return solve


def _from_corners(corners: list[str] | None, width: float | None, height: float | None) -> Solve:
    import numpy as np

    from vision.calibration.plane import plane_from_corners

    if width is None or height is None or len(corners or []) != 4:
        raise fail("give --corner U,V four times, --width-mm and --height-mm", USAGE)
    pixels = np.array([_numbers(corner, "--corner", 2) for corner in corners or []])
    rectangle = width * MM, height * MM
    return lambda _, lens, workspace: plane_from_corners(lens, pixels, rectangle, workspace)


def _from_marks(marks: list[str] | None) -> Solve:
    import numpy as np

    from vision.calibration.plane import plane_from_marks

    if not marks:
        raise fail("give --mark U,V,X,Y at least four times", USAGE)
    numbers = np.array([_numbers(mark, "--mark", 4) for mark in marks])
    return lambda _, lens, workspace: plane_from_marks(lens, numbers[:, :2], numbers[:, 2:] * MM, workspace)


def _numbers(text: str, option: str, count: int) -> list[float]:
    parts = text.split(",")
    try:
        numbers = [float(part) for part in parts]
    except ValueError:
        numbers = []
    if len(numbers) != count or not all(map(math.isfinite, numbers)):
        raise fail(f"{option} takes {count} finite numbers with commas between them, not {text!r}", USAGE)
    return numbers


def _result(rig_file: RigFile, fit: PlaneFit, identity: str) -> tuple[dict[str, Any], dict[str, Any]]:
    """What is shown, and what of it goes into the rig file."""
    from server.api.calibration_answers import plane_json
    from server.calibration.optics import plane_section, today

    saved = rig_file.camera.lens
    lens_date = saved.date if saved is not None and saved.size_px == fit.lens.size else ""
    changes = {"camera": {"plane": plane_section(fit, identity, today(), lens_date)}}
    workspace = 0.5 * rig_file.limits.workspace_mm * MM
    return {**plane_json(fit, workspace), "identity": identity, "remarks": list(fit.remarks)}, changes


def _words(fit: PlaneFit, camera: CameraSection) -> list[str]:
    model = fit.model
    words = [
        f"positions over the workspace are known to {fit.residual / MM:.3f} mm RMS",
        f"points agree to {fit.residual_picture:.3f} px, scale {model.scale_at(0.0, 0.0) * MM:.4f} px/mm, camera "
        f"{fit.camera_height / MM:.1f} mm above the plate, tilted by {math.degrees(fit.tilt):.2f} degrees",
        *fit.remarks,
    ]
    if camera.lens is None:
        words.append(
            "the lens is not calibrated, so that it is as the rig file assumes: positions may be further off"
        )
    return words
