"""Tells somebody outside of faults and of what has ended, when the rig file gives an address for it."""

from __future__ import annotations

import asyncio
import contextlib
import time
from collections.abc import Mapping
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

from control.runs import RunState
from server.notification_section import Occasion
from server.postman import Letter, Postman
from server.streams import StreamEnded
from server.studies.condition import ENDED

if TYPE_CHECKING:
    from server.rig import Rig

CODE = "notifications"
"""Of the lines in the event log."""
BY_HAND = frozenset({"estop", "ended"})
"""Codes of what a person has done; that person knows of it."""
AGAIN_AFTER = 60.0
"""The same fault is told again only after this time, s: one that comes and goes is not told each time."""
RUN_ENDS = {state.value for state in RunState if state is not RunState.RUNNING}


class Notifier:
    """Of one rig. address: of its dashboard, "" where it is not known."""

    def __init__(self, rig: Rig) -> None:
        self._rig = rig
        self.address = ""
        self._postman: Postman | None = None
        self._task: asyncio.Task[None] | None = None
        self._told_at: dict[str, float] = {}

    def start(self) -> None:
        events = asyncio.get_running_loop()

        def tell(words: str) -> None:
            with contextlib.suppress(RuntimeError):  # the server has ended meanwhile
                events.call_soon_threadsafe(self._rig.announce, "warn", CODE, words)

        self._postman = Postman(tell)
        self._task = asyncio.create_task(self._run(), name="notifications")

    async def stop(self) -> None:
        if self._task is not None:
            self._task.cancel()
            await asyncio.gather(self._task, return_exceptions=True)
        if self._postman is not None:
            await asyncio.to_thread(self._postman.close)

    async def _run(self) -> None:
        with contextlib.suppress(StreamEnded):
            async with self._rig.announcements.subscribe() as messages:
                while True:
                    self._heed(await messages.get())

    def _heed(self, message: Mapping[str, Any]) -> None:
        section = self._rig.settings.notifications
        if not section.webhook_url or self._postman is None:
            return
        occasion, words = told_of(message)
        if occasion is None or occasion not in section.on or self._is_known(occasion, message):
            return
        body = self.body(occasion, words)
        self._postman.send(Letter(section.webhook_url, section.timeout_s, body))

    def _is_known(self, occasion: Occasion, message: Mapping[str, Any]) -> bool:
        """A fault that was told of a moment ago, or a run of a study, which is told of as a whole."""
        if occasion == "run":
            return any(run.request.study for run in self._rig.runs if run.id == message["run"]["id"])
        return occasion == "fault" and self._was_told(message["code"])

    def _was_told(self, code: str) -> bool:
        now = time.monotonic()
        before = self._told_at.get(code)
        if before is not None and now - before < AGAIN_AFTER:
            return True
        self._told_at[code] = now
        return False

    def body(self, event: Occasion | str, message: str) -> dict[str, Any]:
        """What is sent. time: ISO 8601, UTC."""
        return {
            "event": event,
            "rig": self._rig.settings.name,
            "time": datetime.now(UTC).isoformat(timespec="seconds"),
            "message": message,
            "url": self.address,
        }


def told_of(message: Mapping[str, Any]) -> tuple[Occasion | None, str]:
    """What a message of the rig's announcements is worth to somebody who is away, in words."""
    match message:
        case {"type": "event", "severity": "error", "code": code, "message": words} if code not in BY_HAND:
            return "fault", str(words)
        case {"type": "study", "event": "ended", "study": study} if study["state"] in ENDED:
            return "study", _of_study(study)
        case {"type": "run", "event": event, "run": {"unattended": True} as run} if event in RUN_ENDS:
            return "run", _of_run(run)
    return None, ""


def _of_study(study: Mapping[str, Any]) -> str:
    reason = f" ({study['reason']})" if study["reason"] else ""
    return f"the study {study['name']} has {study['state']}{reason}: {study['done']} of {study['total']} runs"


def _of_run(run: Mapping[str, Any]) -> str:
    reason = f" ({run['reason']})" if run["reason"] else ""
    how = "has finished" if run["state"] == RunState.FINISHED else f"was {run['state']}"
    return f"the run {run['label'] or run['id']} {how}{reason}"
