"""What the archive needs while nobody waits for it: torn recordings are mended at the start, old ones deleted.

All of it happens in threads of its own, after the server has begun to serve. What was done is told in the event log;
so is what fails, which is tried again at the next occasion. A program that ends does not wait for it: a recording is
mended or deleted whole or not at all.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import threading
import time
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from control.runs import RunState
from server.archive import Archive
from server.catalogue.rebuilding import put_in_order
from server.catalogue.retention import Policy, prune
from server.recording.recovery import recover
from server.streams import StreamEnded

if TYPE_CHECKING:
    from server.rig import Rig

log = logging.getLogger(__name__)

CODE = "archive"
"""Of the lines in the event log."""
WRITTEN_WITHIN = 10.0
"""A recording is whole so soon after its run, s; else the end of the next run is early enough."""
LEAVING = 1.0
"""At the end, what is nearly done is waited for, s."""
BREATH = 0.005
"""After each quarter second of a recording that is mended the rig's thread has the processor, s."""
TOLD = 3
"""Mended recordings in one line of the log."""
MB = 1e6


class Upkeep:
    """Of one archive, as long as its server runs."""

    def __init__(self, archive: Archive, rig: Rig) -> None:
        self._archive = archive
        self._rig = rig
        self._task: asyncio.Task[None] | None = None
        self._thread: threading.Thread | None = None

    def start(self) -> None:
        self._task = asyncio.create_task(self._run(), name="upkeep of the archive")

    async def stop(self) -> None:
        """Begin nothing more."""
        if self._task is not None:
            self._task.cancel()
            await asyncio.gather(self._task, return_exceptions=True)
        if self._thread is not None:
            await asyncio.to_thread(self._thread.join, LEAVING)

    async def _run(self) -> None:
        with contextlib.suppress(StreamEnded):
            async with self._rig.announcements.subscribe() as messages:
                await self._do(self._mend)
                await self._do(lambda: put_in_order(self._archive))
                if self._has_policy:
                    await self._do(self._delete_old)
                while True:
                    message = await messages.get()
                    if self._has_policy and message["type"] == "run" and message["event"] in _ENDS:
                        await self._do(partial(self._delete_old_after, message["run"]["id"]))

    @property
    def _has_policy(self) -> bool:
        section = self._rig.settings.recording
        return section.keep_days > 0.0 or section.keep_GB > 0.0

    async def _do(self, work: Callable[[], str]) -> None:
        """One piece of work, and a line of the log for what it has to say, if anything."""
        try:
            told = await self._aside(work)
        except Exception as error:
            log.exception("the archive could not be looked after")
            self._rig.announce("warn", CODE, f"the archive of runs could not be looked after: {error}")
        else:
            if told:
                self._rig.announce("info", CODE, told)

    async def _aside(self, work: Callable[[], str]) -> str:
        """Done by a thread that nobody has to wait for."""
        loop = asyncio.get_running_loop()
        done: asyncio.Future[str] = loop.create_future()

        def run() -> None:
            result: str | Exception
            try:
                result = work()
            except Exception as error:  # noqa: BLE001 (it goes to who has asked)
                result = error
            with contextlib.suppress(RuntimeError):  # the server has ended meanwhile
                loop.call_soon_threadsafe(_settle, done, result)

        self._thread = threading.Thread(target=run, name="upkeep", daemon=True)
        self._thread.start()
        return await done

    # The work ------------------------------------------------------------------------------------

    def _mend(self) -> str:
        done = recover(self._archive.folder, self._archive.catalogue, lambda: time.sleep(BREATH))
        more = f"; and {len(done) - TOLD} more" if len(done) > TOLD else ""
        return "; ".join(each.said for each in done[:TOLD]) + more

    def _delete_old_after(self, id: str) -> str:
        self._archive.recorder.written(id, WRITTEN_WITHIN)
        return self._delete_old()

    def _delete_old(self) -> str:
        """Runs that the rig file says are old enough, or too many."""
        section = self._rig.settings.recording
        gone = prune(self._archive, Policy(keep_days=section.keep_days, keep_GB=section.keep_GB))
        if not gone:
            return ""
        size = sum(run.size_bytes for run in gone) / MB
        number = "one old run was" if len(gone) == 1 else f"{len(gone)} old runs were"
        return f"{number} deleted ({size:.1f} MB), as [recording] of the rig file says"


_ENDS = {state.value for state in RunState if state is not RunState.RUNNING}


def _settle(done: asyncio.Future[str], result: str | Exception) -> None:
    if done.done():
        return
    if isinstance(result, Exception):
        done.set_exception(result)
    else:
        done.set_result(result)
