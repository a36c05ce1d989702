"""What the loop has to tell: lines of the event log, and runs that have ended."""

from __future__ import annotations

from dataclasses import dataclass

from control.metrics import Metrics
from control.runs import RunState


@dataclass(frozen=True, slots=True)
class Announcement:
    """One line of the event log. severity: "info", "warn" or "error".  time: rig time, s."""

    time: float
    severity: str
    code: str
    message: str


@dataclass(frozen=True, slots=True)
class Ended:
    """How a run ended."""

    id: str
    state: RunState
    reason: str
    metrics: Metrics
