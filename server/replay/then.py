"""What a recording says of the conditions it was made under, as far as this version understands them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from pydantic import ValidationError

from control.gait import Gait, TimeLaw
from control.gait_settings import GaitSettings
from control.trajectories.waypoints import WaypointsParameters
from server.settings import RigFile
from vision.camera_model import CameraModel, Rotation

Settings = Mapping[str, Any]
"""settings.json of a recording; see `server.recording.conditions`."""
LEAST_WORKSPACE_MM = 1.0


def recorded_rig(settings: Settings) -> dict[str, Any]:
    """The rig file's values as JSON, without a network camera's password; empty where they are lost."""
    rig = settings.get("rig")
    return (
        {name: value for name, value in rig.items() if name != "simulated"} if isinstance(rig, dict) else {}
    )


def rig_of(settings: Settings) -> RigFile | None:
    """The rig file of the run; None where it is lost or of a layout that this version does not know."""
    rig = recorded_rig(settings)
    try:
        return RigFile.model_validate(rig) if rig else None
    except ValidationError:
        return None


def exact_gait(settings: Settings, gait: GaitSettings) -> Gait:
    """The gait with every digit that it had, as far as the recording tells; else as it is shown."""
    try:
        values = settings["run"]["gait_SI"]
        exact = Gait(**{**values, "time_law": TimeLaw(values["time_law"])})
        return exact if GaitSettings.from_si(exact) == gait else gait.to_si()
    except (KeyError, TypeError, ValueError, AttributeError):
        return gait.to_si()


def saved_path(settings: Settings) -> tuple[str, WaypointsParameters] | None:
    """Name and points of the path that somebody had saved and the run walked; None where it was another one."""
    path = settings.get("custom_path")
    if not isinstance(path, dict):
        return None
    values = {name: value for name, value in path.items() if name != "name"}
    try:
        return str(path["name"]), WaypointsParameters.model_validate(values)
    except (KeyError, ValidationError):
        return None


def reference_points(settings: Settings) -> list[list[float]]:
    """Of the path that was to be walked, mm; none where they are lost."""
    points = settings.get("reference_points_mm")
    return points if isinstance(points, list) and all(map(is_point, points)) else []


def is_point(value: Any) -> bool:
    return isinstance(value, list) and len(value) == 2 and all(map(is_number, value))


def is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def camera_of(settings: Settings) -> dict[str, Any] | None:
    """The camera as `GET /camera` tells of one; None where it is lost."""
    try:
        camera = settings["camera"]
        return {
            "size": camera["size_px"],
            "model": {
                **{name: camera[f"{name}_px"] for name in ("fx", "fy", "cx", "cy")},
                "distortion": camera["distortion"],
                "rotation": [value for row in camera["rotation"] for value in row],
                "translation_mm": camera["translation_mm"],
                "body_height_mm": settings["body_height_mm"],
            },
        }
    except (KeyError, TypeError):
        return None


def camera_model_of(settings: Settings) -> CameraModel | None:
    """The camera that the run was seen by; None where it is lost."""
    try:
        camera = settings["camera"]
        fx, fy, cx, cy = (float(camera[f"{name}_px"]) for name in ("fx", "fy", "cx", "cy"))
        width, height = map(int, camera["size_px"])
        k1, k2, p1, p2, k3 = map(float, camera["distortion"])
        rotation = rotation_of(camera["rotation"])
        x, y, z = (float(value) * 1e-3 for value in camera["translation_mm"])
        return CameraModel((width, height), fx, fy, cx, cy, (k1, k2, p1, p2, k3), rotation, (x, y, z))
    except (KeyError, TypeError, ValueError):
        return None


def rotation_of(rows: Sequence[Sequence[float]]) -> Rotation:
    """Raises ValueError for what is not 3 x 3."""
    (a, b, c), (d, e, f), (g, h, i) = (map(float, row) for row in rows)
    return (a, b, c), (d, e, f), (g, h, i)


def gait_field(settings: Settings) -> float | None:
    """The field that the run's gait asked for, T; None where it is lost."""
    try:
        field = settings["run"]["gait_SI"]["field"]
    except (KeyError, TypeError):
        return None
    return float(field) if is_number(field) and field > 0.0 else None


def workspace_half_mm(settings: Settings) -> float | None:
    """Half of the square's side."""
    half = settings.get("workspace_mm", 0.0)
    return half if is_number(half) and half >= LEAST_WORKSPACE_MM else None


def robot_length_mm(settings: Settings) -> float | None:
    """Between the pivots."""
    rig = rig_of(settings)
    return None if rig is None else rig.robot.length_mm
