"""The trajectories there are, a look at one before it is walked, and saving one's own."""

from __future__ import annotations

from typing import Any

import numpy as np
from fastapi import APIRouter
from numpy.typing import NDArray

from control.trajectories import OutsideWorkspace, Trajectory, Waypoints, check_inside, trajectories
from control.trajectories.trajectory import MM, length_of, points_of
from server.api.access import TheRig
from server.api.body import StrictRoute
from server.api.choices import checked, listing, taken
from server.api.problems import Rejected, invalid_field
from server.api.schemas import ChoiceBody, CustomPathBody, PreviewBody

router = APIRouter(tags=["trajectories"], route_class=StrictRoute)

PREVIEW_POINTS = 400
"""Enough for a smooth picture of any path here."""


@router.get("/trajectories")
async def list_trajectories() -> list[dict[str, Any]]:
    """Each with the JSON schema of its parameters; saved paths come last."""
    return listing(trajectories)


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


@router.post("/trajectories", status_code=201)
async def save(body: CustomPathBody, rig: TheRig) -> dict[str, Any]:
    """Keep a path under a name; refused when the name is taken or the path leaves the workspace."""
    if body.name in trajectories:
        raise Rejected(taken(body.name, trajectories))
    settings = body.model_dump(exclude={"name"})
    choice = checked(trajectories, ChoiceBody(name=Waypoints.name, parameters=settings))
    inside(trajectories.build(choice.name, choice.parameters), rig, ("points_mm",))
    points = np.array(body.points_mm) * MM
    rig.custom_trajectories.save(body.name, points, body.closed, body.speed_mm_s * MM, body.kind)
    return {"name": body.name, **settings}


def inside(trajectory: Trajectory, rig: TheRig, where: tuple[str, ...]) -> None:
    half_size = rig.coils.workspace
    try:
        check_inside(trajectory, half_size)
    except OutsideWorkspace as error:
        allowed = f"within ±{half_size / MM:g} mm of the centre in x and y"
        raise Rejected(invalid_field(where, str(error), allowed)) from None


def rounded_points(points: NDArray[np.float64]) -> list[list[float]]:
    return np.round(points / MM, 3).tolist()
