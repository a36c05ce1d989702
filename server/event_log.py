"""What has happened in this session, and everybody who is told of it."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any

from control.news import Announcement
from server.api.runs import run_json
from server.run_list import News
from server.streams import Publisher, announcer

EVENTS_KEPT = 5000
"""Lines; a few MB at most."""


@dataclass(frozen=True, slots=True)
class Event:
    """One line of the log. number: counts from 1.  at: on the wall's clock.  run_id: the run that went on, or ""."""

    number: int
    line: Announcement
    at: datetime
    run_id: str

    @property
    def time(self) -> float:
        """Rig time, s."""
        return self.line.time

    @property
    def severity(self) -> str:
        return self.line.severity

    @property
    def code(self) -> str:
        return self.line.code

    @property
    def message(self) -> str:
        return self.line.message


@dataclass(frozen=True, slots=True)
class Told:
    """A line with the instant at which it was heard, and the run that was going on then."""

    line: Announcement
    at: datetime
    run_id: str

    @classmethod
    def now(cls, line: Announcement, run_id: str) -> Told:
        return cls(line, datetime.now(UTC), run_id)


class EventLog:
    """entries: oldest first.  messages: what goes to every client as it comes.  listeners: told of each line."""

    def __init__(self) -> None:
        self.listeners: list[Callable[[Event], None]] = []
        self.entries: deque[Event] = deque(maxlen=EVENTS_KEPT)
        self.messages: Publisher[dict[str, Any]] = announcer()
        self._count = 0

    def add(self, told: Told) -> None:
        self._count += 1
        event = Event(self._count, told.line, told.at, told.run_id)
        self.entries.append(event)
        for listener in self.listeners:
            listener(event)
        self.messages.publish({"type": "event", **event_json(event)})

    def tell_runs(self, news: Iterable[News]) -> None:
        for event, run in news:
            self.messages.publish({"type": "run", "event": event, "run": run_json(run)})


def event_json(event: Event) -> dict[str, Any]:
    """number: counts up through a session of the server.  at: ISO 8601, UTC."""
    return {
        "number": event.number,
        "time_s": round(event.time, 4),
        "at": event.at.isoformat(timespec="milliseconds"),
        "severity": str(event.severity),
        "code": event.code,
        "message": event.message,
        "run_id": event.run_id or None,
    }
