"""A walk of the simulated rig, recorded as `pivotrig run` records it, with every snapshot beside it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from control.runs import RunRequest, Selection
from control.snapshot import Snapshot
from server.archive import Archive
from server.assembly import build_machine
from server.catalogue.records import RunRecord
from server.headless import Headless
from server.recording.reading.recording import Recording
from server.settings import RigFile


def outcome_of(path: Path) -> dict[str, Any]:
    """How the recording ended, which it must have done."""
    with Recording.open(path) as recording:
        assert recording.outcome is not None
        return recording.outcome


@dataclass(frozen=True)
class Walked:
    """snapshots: all of the rig's ticks, by tick number, before and after the run included."""

    path: Path
    row: RunRecord
    snapshots: dict[int, Snapshot]


def record_walk(data: Path, id: str, duration: float, **recording: Any) -> Walked:
    """recording: of the rig file's section."""
    settings = RigFile.model_validate({"recording": recording})
    archive = Archive.open(data, patient=True)
    snapshots: dict[int, Snapshot] = {}
    try:
        machine = build_machine(settings, realtime=False, data=data)
        walk = Headless(machine, lambda seen: snapshots.update({seen.tick: seen}), archive.recorder)
        walk.run(id, RunRequest(Selection(), duration=duration, label="a walk"))
        archive.recorder.close()
        return Walked(archive.path_of(id), archive.catalogue.get(id), snapshots)
    finally:
        archive.close()
