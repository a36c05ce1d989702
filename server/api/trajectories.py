"""The trajectories there are, a look at one before it is walked, and one's own: saved, renamed, deleted."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from fastapi import APIRouter
from numpy.typing import NDArray

from control.runs import RunState
from control.safety import Refused
from control.trajectories import OutsideWorkspace, Trajectory, Waypoints, check_inside, trajectories
from control.trajectories.trajectory import MM, length_of, points_of
from control.trajectories.waypoint_file import ALLOWED, WaypointFileError, read_points
from server.api.access import TheDesk, TheRig
from server.api.body import StrictRoute
from server.api.choices import checked, listing, taken
from server.api.problems import Problem, Rejected, invalid_field
from server.api.schemas import (
    ChoiceBody,
    CustomPathBody,
    PathName,
    PointsTextBody,
    PreviewBody,
    RenameBody,
)
from server.custom_trajectories import NamedPath
from server.studies.desk import StudyDesk

router = APIRouter(tags=["trajectories"], route_class=StrictRoute)

PREVIEW_POINTS = 400
"""Enough for a smooth picture of any path here."""


@router.get("/trajectories")
async def list_trajectories(rig: TheRig) -> list[dict[str, Any]]:
    """Each with the JSON schema of its parameters; saved paths come last, and say so by `saved`."""
    own = {path.name for path in rig.custom_trajectories.all()}
    return [{**entry, "saved": entry["name"] in own} for entry in listing(trajectories)]


@router.post("/trajectories/preview")
def preview(body: PreviewBody, rig: TheRig) -> dict[str, Any]:
    """The path's points, length and the duration of one pass at a path step of 0.1 s."""
    choice = checked(trajectories, body)
    trajectory = trajectories.build(choice.name, choice.parameters)
    inside(trajectory, rig, ("parameters",))
    return {
        "points_mm": rounded_points(points_of(trajectory, PREVIEW_POINTS)),
        "length_mm": round(length_of(trajectory) / MM, 3),
        "duration_s": round(trajectory.duration, 6),
    }


@router.post("/trajectories/points")
def read_text(body: PointsTextBody) -> dict[str, Any]:
    """The points of a file's text: CSV with x and y in mm a line, or a JSON list of [x, y]."""
    try:
        points = read_points(body.text)
    except WaypointFileError as error:
        raise Rejected(invalid_field(("text",), str(error), ALLOWED.removeprefix("allowed: "))) from None
    return {"points_mm": [list(point) for point in points]}


@router.post("/trajectories", status_code=201)
async def save(body: CustomPathBody, rig: TheRig) -> dict[str, Any]:
    """Keep a path under a name; refused when the name is taken or the path leaves the workspace."""
    paths = rig.custom_trajectories
    if body.name in trajectories:
        raise Rejected(taken(body.name, trajectories))
    settings = body.model_dump(exclude={"name"})
    choice = checked(trajectories, ChoiceBody(name=Waypoints.name, parameters=settings))
    inside(trajectories.build(choice.name, choice.parameters), rig, ("points_mm",))
    points = np.array(body.points_mm) * MM
    paths.save(body.name, points, body.closed, body.speed_mm_s * MM, body.kind)
    try:
        await paths.keep()
    except Refused:
        paths.forget(body.name)
        raise
    tell(rig)
    return {"name": body.name, **settings}


@router.get("/trajectories/{name}")
async def one(name: PathName, rig: TheRig) -> dict[str, Any]:
    """A saved path, as `POST /trajectories` takes it."""
    return saved(rig, name).to_json()


@router.patch("/trajectories/{name}")
async def rename(name: PathName, body: RenameBody, rig: TheRig, studies: TheDesk) -> dict[str, Any]:
    """Another name for a saved path; refused while the rig uses it."""
    paths, path = rig.custom_trajectories, saved(rig, name)
    require_unused(rig, studies, name, "rename")
    if body.name in trajectories:
        raise Rejected(taken(body.name, trajectories))
    paths.forget(name)
    put(rig, replace(path, name=body.name))
    try:
        await paths.keep()
    except Refused:
        paths.forget(body.name)
        put(rig, path)
        raise
    tell(rig)
    return {**path.to_json(), "name": body.name}


@router.delete("/trajectories/{name}")
async def forget(name: PathName, rig: TheRig, studies: TheDesk) -> dict[str, Any]:
    """Take a saved path out; the answer is what saves it again. Refused while the rig uses it."""
    paths, path = rig.custom_trajectories, saved(rig, name)
    require_unused(rig, studies, name, "delete")
    paths.forget(name)
    try:
        await paths.keep()
    except Refused:
        put(rig, path)
        raise
    tell(rig)
    return path.to_json()


def saved(rig: TheRig, name: str) -> NamedPath:
    path = rig.custom_trajectories.find(name)
    if path is None:
        known = ", ".join(each.name for each in rig.custom_trajectories.all()) or "none so far"
        raise Rejected(Problem(404, "No such path", f"There is no saved path {name!r}; there are: {known}."))
    return path


def put(rig: TheRig, path: NamedPath) -> None:
    whole = path.whole
    points = np.array(whole.points_mm) * MM
    rig.custom_trajectories.save(path.name, points, whole.closed, whole.speed_mm_s * MM, whole.kind)


def require_unused(rig: TheRig, studies: StudyDesk, name: str, verb: str) -> None:
    """What a run walks, or the next one will, keeps its name."""
    if (study := studies.campaign_along(name)) is not None:
        raise Refused(f"the study {study!r} walks along {name!r}; {verb} it when that has ended")
    chosen = rig.selection.trajectory.name == name
    walked = any(
        run.request.selection.trajectory.name == name for run in rig.runs if run.state is RunState.RUNNING
    )
    if chosen or walked:
        why = "is being walked" if walked else "is selected"
        raise Refused(f"{name!r} {why}; choose another trajectory, then {verb} it")


def tell(rig: TheRig) -> None:
    """Every open page lists the trajectories anew."""
    rig.announcements.publish({"type": "rig", "trajectories": list(trajectories)})


def inside(trajectory: Trajectory, rig: TheRig, where: tuple[str, ...]) -> None:
    half_size = rig.coils.workspace
    try:
        check_inside(trajectory, half_size)
    except OutsideWorkspace as error:
        allowed = f"within ±{half_size / MM:g} mm of the centre in x and y"
        raise Rejected(invalid_field(where, str(error), allowed)) from None


def rounded_points(points: NDArray[np.float64]) -> list[list[float]]:
    return np.round(points / MM, 3).tolist()
