"""What the calibrations that let the robot walk have in common: a run to start, what to note, what was found."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import date
from typing import Any, Protocol

from control.model import Pose
from control.runs import RunRequest
from control.snapshot import Snapshot
from server.rig_file import differences, merged
from server.settings import RigFile

ENOUGH_PASSES = 1000.0
"""Such a walk ends by itself; the path, which it does not look at, must not end it sooner."""


@dataclass(frozen=True, slots=True)
class Findings:
    """figures: what is told, in the lab's units.  changes: what of it belongs into the rig file, nested."""

    figures: dict[str, Any]
    changes: dict[str, Any]


class CalibrationWalk(Protocol):
    """One walk, from the question whether it may begin to what it has shown."""

    request: RunRequest
    rests_on: tuple[str, ...]
    """Sections and fields of the rig file, dotted: with other values there, what is found does not hold."""
    advice: str
    """What may be the matter when the walk does not come to its end, "" for nothing special."""

    def check(self, pose: Pose) -> None:
        """Whether it may begin where the robot is; raises `Refused`."""
        ...

    def watch(self, snapshot: Snapshot) -> None:
        """Note what a tick shows; on the rig's thread."""
        ...

    def progress(self, snapshot: Snapshot) -> float:
        """0..1, of a run that is on."""
        ...

    def findings(self) -> Findings:
        """What the walk has shown; raises `TooLittle` or `Unclear`."""
        ...


def changed_since(before: RigFile, now: RigFile, findings: Findings, rests_on: tuple[str, ...]) -> list[str]:
    """Names of the fields that findings rest on and that are no longer as at the measurement (`before`); those
    which the findings themselves have set are as they should be."""
    saved = RigFile.model_validate(merged(before.model_dump(mode="json"), findings.changes))
    edited = set(differences(before, now)) & set(differences(saved, now))
    return sorted(name for name in edited if any(f"{name}.".startswith(f"{part}.") for part in rests_on))


def with_advice(reason: str, advice: str) -> str:
    return f"{reason}; {advice}" if advice else reason


def measured_today(what: str) -> str:
    """What the rig file says of where figures come from."""
    return f"measured {date.today().isoformat()}, {what}"
