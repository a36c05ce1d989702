"""What searches for the best have learned so far: worked out beside the server, since it takes a processor seconds."""

from __future__ import annotations

import asyncio
import json
import logging
import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from server.studies.child import ChildFailed
from server.studies.study import Study

if TYPE_CHECKING:
    from server.studies.desk import StudyDesk

log = logging.getLogger(__name__)

NOTHING: Mapping[str, Any] = {"answer": None, "surface": None}
PAUSE = 3.0
"""While a search goes on, what it learned is worked out anew no sooner than this after the last time, s."""


@dataclass(frozen=True, slots=True)
class Learned:
    """rows: that there were.  shown: as JSON.  at: when, monotonic, s."""

    rows: int
    shown: Mapping[str, Any]
    at: float


class Learning:
    """Belongs to the event loop."""

    def __init__(self, desk: StudyDesk) -> None:
        self._desk = desk
        self._learned: dict[str, Learned] = {}
        self._work: dict[str, asyncio.Task[None]] = {}

    async def of(self, study: Study, rows: int) -> Mapping[str, Any]:
        """`answer` and `surface`; of a search that goes on those that are known, of another those of all its rows."""
        if study.definition.design != "tune" or not rows:
            return NOTHING
        while (known := self._learned.get(study.id)) is None or known.rows < rows:
            if self._desk.work_on(study.id) is not None:
                return self._known_of_one_that_goes_on(study, rows)
            await asyncio.shield(self._at_work(study, rows))
        return known.shown

    def _known_of_one_that_goes_on(self, study: Study, rows: int) -> Mapping[str, Any]:
        known = self._learned.get(study.id)
        if known is None or time.monotonic() - known.at >= PAUSE:
            self._at_work(study, rows)
        return NOTHING if known is None else known.shown

    def forget(self, id: str) -> None:
        self._learned.pop(id, None)

    async def close(self) -> None:
        for work in list(self._work.values()):
            work.cancel()
        await asyncio.gather(*self._work.values(), return_exceptions=True)

    def _at_work(self, study: Study, rows: int) -> asyncio.Task[None]:
        """The one that works on this study."""
        if study.id not in self._work:
            work = asyncio.create_task(self._work_out(study, rows), name=f"learned by {study.id}")
            work.add_done_callback(lambda _: self._work.pop(study.id, None))
            self._work[study.id] = work
        return self._work[study.id]

    async def _work_out(self, study: Study, rows: int) -> None:
        try:
            shown = json.loads(await self._desk.drawn("learned", study))
        except ChildFailed as error:
            log.error("what the study %s has learned cannot be told: %s", study.id, error)
            shown = NOTHING
        self._learned[study.id] = Learned(rows, shown, time.monotonic())
        if self._desk.work_on(study.id) is not None:
            self._desk.tell_of("learned", study)
