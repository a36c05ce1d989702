"""Under which conditions a run is made: everything that is needed to understand it, and to make it again."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import tomlkit

from control.runs import Run, Selection
from control.trajectories import trajectories
from control.trajectories.custom import SavedPath
from control.trajectories.trajectory import MM, points_of
from server.api.choices import selection_json
from server.assembly import Machine
from server.recording.provenance import computer, revision, versions
from server.recording_section import RecordingSection
from server.settings import RigFile
from vision.camera_model import CameraModel

FORMAT = 1
"""Of settings.json and of the topics."""


@dataclass(frozen=True, slots=True)
class Conditions:
    """How the rig is when a run begins. body_height, workspace (half the square's size): m."""

    settings: RigFile
    simulated: bool
    firmware: str
    camera_model: CameraModel
    body_height: float
    workspace: float

    @property
    def recording(self) -> RecordingSection:
        return self.settings.recording


def conditions_of(machine: Machine) -> Conditions:
    """On the rig's thread, so nothing is worked out here."""
    return Conditions(
        settings=machine.settings,
        simulated=machine.settings.is_simulated,
        firmware=machine.link.status.firmware,
        camera_model=machine.camera_model,
        body_height=machine.body_height,
        workspace=machine.coils.workspace,
    )


def settings_json(run: Run, conditions: Conditions) -> dict[str, Any]:
    """What settings.json says; lab units in the names. A network camera's password is no part of it."""
    rig = conditions.settings.to_recorded()
    simulation = conditions.settings.simulation
    return {
        "format": FORMAT,
        "run": run_settings(run),
        "simulated": conditions.simulated,
        "plant": simulation.plant if conditions.simulated else "",
        "seed": simulation.seed if conditions.simulated else None,
        "study": run.request.study,
        "study_run": run.request.study_run,
        "rig": rig,
        "rig_toml": rig_toml(rig),
        "camera": camera_json(conditions.camera_model),
        "body_height_mm": conditions.body_height / MM,
        "workspace_mm": conditions.workspace / MM,
        "reference_points_mm": reference_points(run.request.selection),
        "custom_path": custom_path(run.request.selection),
        "versions": {**versions(), "firmware": conditions.firmware},
        "revision": revision(),
        "computer": computer(),
    }


def run_settings(run: Run) -> dict[str, Any]:
    """What was asked for. gait_SI: with every digit, as `control.gait.Gait` has it."""
    request = run.request
    return {
        "id": run.id,
        "label": request.label,
        "tags": list(request.tags),
        "started_at": run.started_at.isoformat(),
        "passes": request.passes,
        "duration_s": request.duration,
        "unattended": request.unattended,
        **selection_json(request.selection),
        "gait_SI": asdict(request.selection.gait),
    }


def rig_toml(rig: dict[str, Any]) -> str:
    """The rig file that gives this rig again."""
    values = {name: value for name, value in rig.items() if name != "simulated"}
    return tomlkit.dumps(_without_nothing(values))


def _without_nothing(values: dict[str, Any]) -> dict[str, Any]:
    """TOML has no null: what is None is left out."""
    return {
        name: _without_nothing(value) if isinstance(value, dict) else value
        for name, value in values.items()
        if value is not None
    }


def camera_json(model: CameraModel) -> dict[str, Any]:
    """The camera model, for overlays: a workspace point p is R p + t in the camera frame."""
    return {
        "size_px": list(model.size),
        "fx_px": model.fx,
        "fy_px": model.fy,
        "cx_px": model.cx,
        "cy_px": model.cy,
        "distortion": list(model.distortion),
        "rotation": [list(row) for row in model.rotation],
        "translation_mm": [value / MM for value in model.translation],
    }


def reference_points(selection: Selection) -> list[list[float]]:
    """One pass of the path, mm."""
    return (points_of(selection.build_trajectory()) / MM).tolist()


def custom_path(selection: Selection) -> dict[str, Any] | None:
    """A path that somebody drew or sent, as it is saved anew; None for one that the program brings along."""
    entry = trajectories[selection.trajectory.name]
    if not issubclass(entry, SavedPath):
        return None
    return {"name": selection.trajectory.name, **entry.whole.model_dump(mode="json")}
