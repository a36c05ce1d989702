"""`--set trajectory.file=points.csv`: the points of a file, in place of its name."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from control.trajectories import Waypoints
from control.trajectories.waypoint_file import WaypointFileError, read_points


def with_points(trajectory: str, parameters: Mapping[str, Any]) -> dict[str, Any]:
    """The parameters with `file` read into `points_mm`; raises `WaypointFileError`."""
    if "file" not in parameters:
        return dict(parameters)
    others = {name: value for name, value in parameters.items() if name != "file"}
    if trajectory != Waypoints.name:
        raise WaypointFileError(
            f"trajectory.file gives the points of --trajectory {Waypoints.name}, not of {trajectory!r}"
        )
    if "points_mm" in others:
        raise WaypointFileError("trajectory.file and trajectory.points_mm both give the points; drop one")
    return {**others, "points_mm": _points(Path(str(parameters["file"])))}


def _points(path: Path) -> list[tuple[float, float]]:
    try:
        return read_points(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise WaypointFileError(f"cannot read {path}: {error.strerror}") from error
    except UnicodeDecodeError:
        raise WaypointFileError(f"{path} is not a text file; save the points as CSV or JSON") from None
    except WaypointFileError as error:
        raise WaypointFileError(f"{path}: {error}") from None
