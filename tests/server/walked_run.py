"""A real run of the simulated rig, recorded, for tests that look at what becomes of it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

from control.gait import Gait
from control.runs import Choice, RunRequest, Selection
from server.archive import Archive
from server.assembly import build_machine
from server.headless import Headless
from server.settings import RigFile


@dataclass(frozen=True, slots=True)
class WalkedRun:
    """data: the data folder.  path: the run's recording."""

    id: str
    data: Path
    path: Path


def walk(
    data: Path,
    id: str = "20261123-093000-a1b2",
    *,
    duration: float = 4.0,
    label: str = "",
    **recording: object,
) -> WalkedRun:
    """The eight at a sweep of 10 degrees, for `duration` seconds.  recording: changes to [recording]."""
    settings = RigFile.model_validate({"recording": recording})
    gait = Gait(sweep=math.radians(10.0))
    selection = Selection(Choice("geometric"), Choice("eight"), gait)
    archive = Archive.open(data, patient=True)
    try:
        machine = build_machine(settings, realtime=False)
        request = RunRequest(selection, duration=duration, label=label)
        Headless(machine, recorder=archive.recorder).run(id, request)
        return WalkedRun(id, data, archive.path_of(id))
    finally:
        archive.close()
