"""What the loop has to tell: lines of the event log, and runs that have ended."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass

from control.arbiter import Finding, Severity
from control.metrics import Metrics
from control.runs import RunState

LENGTH = 200
"""Lines, and ended runs, that wait for the shell to take them."""
WARN_AGAIN = 10.0
"""A warning that was away for less than this, s, is not told again."""


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


class News:
    """What waits to be taken, oldest first; what nobody takes is forgotten at last."""

    def __init__(self) -> None:
        self._lines: deque[Announcement] = deque(maxlen=LENGTH)
        self._ended: deque[Ended] = deque(maxlen=LENGTH)
        self._warned_at: dict[str, float] = {}

    def add(self, line: Announcement) -> None:
        self._lines.append(line)

    def end(self, run: Ended) -> None:
        self._ended.append(run)

    def warn_of(self, findings: Iterable[Finding], now: float) -> None:
        """A line for each warning that is new, or that comes back after a while."""
        for finding in findings:
            if finding.severity is Severity.WARN:
                if now - self._warned_at.get(finding.code, -math.inf) > WARN_AGAIN:
                    self.add(Announcement(now, "warn", finding.code, finding.message))
                self._warned_at[finding.code] = now

    def take_lines(self) -> list[Announcement]:
        return [self._lines.popleft() for _ in range(len(self._lines))]

    def take_ended(self) -> list[Ended]:
        return [self._ended.popleft() for _ in range(len(self._ended))]
