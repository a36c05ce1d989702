"""What has happened in this session, and everybody who is told of it."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from typing import Any

from control.news import Announcement
from server.api.runs import run_json
from server.run_list import News
from server.streams import Publisher, announcer

EVENTS_KEPT = 1000


class EventLog:
    """entries: oldest first.  messages: what goes to every client as it comes."""

    def __init__(self) -> None:
        self.entries: deque[Announcement] = deque(maxlen=EVENTS_KEPT)
        self.messages: Publisher[dict[str, Any]] = announcer()

    def add(self, announcement: Announcement) -> None:
        self.entries.append(announcement)
        self.messages.publish(
            {
                "type": "event",
                "time_s": round(announcement.time, 4),
                "severity": announcement.severity,
                "code": announcement.code,
                "message": announcement.message,
            }
        )

    def tell_runs(self, news: Iterable[News]) -> None:
        for event, run in news:
            self.messages.publish({"type": "run", "event": event, "run": run_json(run)})
