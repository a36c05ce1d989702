"""Lens and plane of the camera: gather views, solve, look at what came out, save it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Annotated, Any, Literal

import numpy as np
from fastapi import APIRouter, Depends, Query, Response
from pydantic import Field
from starlette.requests import HTTPConnection

from server.api.access import TheChanges, TheRig
from server.api.body import StrictRoute
from server.api.calibration_answers import looked_json, pending_lens_json, pending_plane_json, state_json
from server.api.operator import TheHand
from server.api.problems import Problem, Rejected
from server.api.rig_file import own_file, told
from server.api.schemas import Edge
from server.calibration.board_sheet import board_pdf
from server.calibration.camera import CameraCalibration, NoBoard
from server.calibration.optics import board_of
from server.settings import MM
from vision.calibration.board import Board
from vision.calibration.lens import Lens
from vision.calibration.plane import PlaneFit, plane_from_corners, plane_from_marks
from vision.camera_model import CalibrationError

router = APIRouter(prefix="/calibration", tags=["calibration"], route_class=StrictRoute)

Pixel = Annotated[float, Field(ge=-1e4, le=1e4)]
Millimetres = Annotated[float, Field(ge=-2000.0, le=2000.0)]
Side = Annotated[float, Field(gt=0.0, le=2000.0)]


async def the_calibration(connection: HTTPConnection) -> CameraCalibration:
    calibration: CameraCalibration = connection.app.state.camera_calibration
    calibration.renew()
    return calibration


TheCalibration = Annotated[CameraCalibration, Depends(the_calibration)]


class FromBoard(Edge):
    """The printed board lies flat on the plate; its middle becomes the workspace's origin."""

    method: Literal["board"]


class FromCorners(Edge):
    """The corners of a rectangle, clockwise from its upper left one."""

    method: Literal["corners"]
    points_px: Annotated[
        list[Annotated[list[Pixel], Field(min_length=2, max_length=2)]], Field(min_length=4, max_length=4)
    ]
    width_mm: Side
    height_mm: Side


class Mark(Edge):
    """A mark on the plate: where it is seen, and where it is."""

    u: Pixel
    v: Pixel
    x_mm: Millimetres
    y_mm: Millimetres


class FromMarks(Edge):
    """Marks whose places are known."""

    method: Literal["marks"]
    marks: Annotated[list[Mark], Field(min_length=4, max_length=200)]


PlaneBody = Annotated[FromBoard | FromCorners | FromMarks, Field(discriminator="method")]


@contextmanager
def worked_out() -> Iterator[None]:
    """What does not work out is a problem document."""
    try:
        yield
    except NoBoard as error:
        raise Rejected(Problem(422, "No board", str(error))) from error
    except CalibrationError as error:
        raise Rejected(Problem(422, "No calibration", str(error))) from error


@router.get("")
async def state(calibration: TheCalibration) -> dict[str, Any]:
    """What is saved and whether it fits this camera, and what has been found since."""
    return state_json(calibration)


@router.post("/lens/views")
async def take_view(calibration: TheCalibration) -> dict[str, Any]:
    """Look for the board in the newest picture and take it as a view, if it brings something new."""
    with worked_out():
        return looked_json(calibration, await calibration.look())


@router.delete("/lens/views")
async def forget_views(calibration: TheCalibration) -> dict[str, Any]:
    """Drop the views, and begin anew."""
    calibration.forget_views()
    return state_json(calibration)


@router.post("/lens")
async def solve_lens(calibration: TheCalibration) -> dict[str, Any]:
    """The lens from the views that were taken; nothing is saved yet."""
    with worked_out():
        fit = await calibration.solve_lens()
    return {**state_json(calibration), "pending_lens": pending_lens_json(fit)}


@router.post("/plane")
async def solve_plane(body: PlaneBody, calibration: TheCalibration) -> dict[str, Any]:
    """Where the camera is over the plate; nothing is saved yet."""
    with worked_out():
        match body:
            case FromBoard():
                fit = await calibration.plane_of_board()
            case FromCorners():
                fit = await calibration.solve_plane(_corners(body))
            case FromMarks():
                fit = await calibration.solve_plane(_marks(body))
    return {**state_json(calibration), "pending_plane": pending_plane_json(calibration, fit)}


def _corners(body: FromCorners) -> Callable[[Lens, float], PlaneFit]:
    pixels, rectangle = np.array(body.points_px, float), (body.width_mm * MM, body.height_mm * MM)
    return lambda lens, workspace: plane_from_corners(lens, pixels, rectangle, workspace)


def _marks(body: FromMarks) -> Callable[[Lens, float], PlaneFit]:
    pixels = np.array([(mark.u, mark.v) for mark in body.marks])
    places = np.array([(mark.x_mm, mark.y_mm) for mark in body.marks]) * MM
    return lambda lens, workspace: plane_from_marks(lens, pixels, places, workspace)


@router.post("/save")
async def save(calibration: TheCalibration, changes: TheChanges, hand: TheHand) -> dict[str, Any]:
    """Write what was found into the rig file; the rig, which must be disarmed, is rebuilt with it."""
    lens, plane = calibration.lens, calibration.plane
    with told():
        await own_file(changes).patch(calibration.changes(), hand.require)
    calibration.saved(lens, plane)
    return state_json(calibration)


@router.delete("")
async def take_out(calibration: TheCalibration, changes: TheChanges, hand: TheHand) -> dict[str, Any]:
    """Back to the optics that the rig file assumes; what was found and not saved goes, too."""
    with told():
        await own_file(changes).patch({"camera": {"lens": None, "plane": None}}, hand.require)
    calibration.forget()
    return state_json(calibration)


@router.get(
    "/board.pdf",
    response_class=Response,
    responses={200: {"content": {"application/pdf": {}}}},
)
async def board(
    rig: TheRig,
    columns: Annotated[int | None, Query(ge=4, le=40)] = None,
    rows: Annotated[int | None, Query(ge=4, le=40)] = None,
    square_mm: Annotated[float | None, Query(ge=3.0, le=100.0, allow_inf_nan=False)] = None,
) -> Response:
    """The board to print at 100 %; what is left out is as the rig file has it."""
    own = board_of(rig.settings.camera)
    chosen = Board(
        own.columns if columns is None else columns,
        own.rows if rows is None else rows,
        own.square if square_mm is None else square_mm * MM,
    )
    pdf = await asyncio.to_thread(board_pdf, chosen)
    return Response(
        pdf, media_type="application/pdf", headers={"Content-Disposition": 'inline; filename="board.pdf"'}
    )
