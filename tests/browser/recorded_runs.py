"""Runs for a server to find: walks of the simulated rig, computed and recorded before it starts."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

from control.gait import Gait
from control.runs import Choice, RunRequest, Selection
from server.archive import Archive
from server.assembly import build_machine
from server.headless import Headless
from server.settings import RigFile


def walk(archive: Archive, label: str, sweep_deg: float, duration: float, trajectory: str = "circle") -> str:
    """What is walked for `duration` s; the id of the run, which ends with the first word of its label."""
    id = f"20260101-000000-{label.split()[0]}"
    gait = Gait(sweep=math.radians(sweep_deg))
    selection = replace(Selection(), trajectory=Choice(trajectory, {}), gait=gait)
    request = RunRequest(selection, duration=duration, label=label)
    Headless(build_machine(RigFile(), realtime=False), recorder=archive.recorder).run(id, request)
    return id


def record(data: Path, label: str, sweep_deg: float, duration: float, trajectory: str = "circle") -> str:
    """The same into a folder of data, with a recorder of its own, which has written all of it in the end."""
    archive = Archive.open(data, patient=True)
    try:
        return walk(archive, label, sweep_deg, duration, trajectory)
    finally:
        archive.close()
