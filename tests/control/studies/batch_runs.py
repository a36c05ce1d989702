"""Runs of a batch for tests: one line a run."""

from __future__ import annotations

import math
from typing import Any

from control.gait import Gait
from control.model import Pose
from control.runs import Choice, Selection
from control.simulation.plants import PlantChoice
from control.studies.plan import PlannedRun

BOTTOM = Pose(0.0, -0.040, math.pi)
"""Where the eight begins, along it."""


def planned(
    controller: str | Choice = "geometric",
    plant: str | PlantChoice = "slip",
    gait: Gait | None = None,
    trajectory: str | Choice = "eight",
    **further: Any,
) -> PlannedRun:
    """Six seconds of a walk unless `duration` says otherwise. further: fields of `PlannedRun`."""
    law, path = (c if isinstance(c, Choice) else Choice(c) for c in (controller, trajectory))
    run = {"seed": 1, "duration": 6.0, "start": BOTTOM, **further}
    return PlannedRun(
        index=0,
        set=0,
        repeat=0,
        values={},
        selection=Selection(law, path, gait or Gait()),
        plant=plant if isinstance(plant, PlantChoice) else PlantChoice(plant),
        **run,
    )
