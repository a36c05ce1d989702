"""What a run is made of: the choice of controller, trajectory and gait, and the record of one run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime
from enum import StrEnum
from typing import Any

from control.controllers import Controller, controllers
from control.gait import Gait
from control.metrics import Metrics
from control.trajectories import Trajectory, trajectories


@dataclass(frozen=True, slots=True)
class Choice:
    """A controller or trajectory by name, with its parameters in the lab units of its parameter model."""

    name: str
    parameters: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Selection:
    """What the page shows and the next run uses."""

    controller: Choice = Choice("geometric")
    trajectory: Choice = Choice("eight")
    gait: Gait = Gait()

    def build_controller(self) -> Controller:
        """A fresh controller; raises `UnknownName` or pydantic's `ValidationError`."""
        return controllers.build(self.controller.name, self.controller.parameters)

    def build_trajectory(self) -> Trajectory:
        """The reference path; raises like `build_controller`."""
        return trajectories.build(self.trajectory.name, self.trajectory.parameters)


@dataclass(frozen=True, slots=True)
class RunRequest:
    """A run to start. passes: of the reference path.  duration: a cap, s, None for no cap.

    unattended: the run belongs to the server and outlives the browser that started it.
    study, study_run: the id of the study that it belongs to, and which of its runs it is; "" and None for none.
    """

    selection: Selection
    passes: float = 1.0
    duration: float | None = None
    unattended: bool = False
    label: str = ""
    tags: tuple[str, ...] = ()
    study: str = ""
    study_run: int | None = None


class RunState(StrEnum):
    RUNNING = "running"
    FINISHED = "finished"
    STOPPED = "stopped"
    ABORTED = "aborted"


@dataclass(frozen=True, slots=True)
class Run:
    """One run as the catalogue lists it; `metrics` is None until it has ended."""

    id: str
    request: RunRequest
    state: RunState
    started_at: datetime
    reason: str = ""
    metrics: Metrics | None = None
