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
from collections.abc import Callable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any

from control.runs import RunState
from server.archive import Archive
from server.catalogue.rebuilding import put_in_order
from server.catalogue.records import Loose
from server.catalogue.retention import Policy, prune
from server.recording.recovery.recover import recover
from server.streams import Mailbox, StreamEnded

if TYPE_CHECKING:
    from server.rig import Rig

log = logging.getLogger(__name__)

CODE = "archive"
"""Of the lines in the event log."""
WRITTEN_WITHIN = 10.0
"""A recording is whole so soon after its run, s; else the end of the next run is early enough."""
LEAVING = 1.0
"""At the end, what is nearly done is waited for, s."""
LOOK_AGAIN = 5.0
"""A catalogue that was lost or exchanged while the server ran is filled again within this time, s."""
BREATH = 0.005
"""After each quarter second of a recording that is mended, and each that is read, the rig has the processor, s."""
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
        self._put_in_order_for = 0
        """The catalogue's file is the how many-th that this server has opened."""

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
                if await self._do(self._mend):
                    self._tell_pages("listed")
                await self._put_in_order()
                if self._has_policy:
                    await self._delete_old()
                while True:
                    await self._heed(await _next(messages))

    async def _heed(self, message: Mapping[str, Any]) -> None:
        if self._archive.catalogue.exchanges != self._put_in_order_for:
            await self._put_in_order()
        if self._has_policy and message["type"] == "run" and message["event"] in _ENDS:
            await self._delete_old(after=message["run"]["id"])

    async def _put_in_order(self) -> None:
        self._put_in_order_for = self._archive.catalogue.exchanges
        if await self._do(lambda: put_in_order(self._archive, _breathe)):
            self._tell_pages("listed")

    async def _delete_old(self, after: str | None = None) -> None:
        """What the rig file does not want kept. after: the run that has just ended."""
        gone: list[Loose] = []
        if await self._do(partial(self._prune, gone, after)):
            for run in gone:
                self._rig.runs.forget(run.id)
            self._tell_pages("pruned", runs=len(gone))

    def _tell_pages(self, event: str, **more: int) -> None:
        """The list of runs is another one."""
        self._rig.announcements.publish({"type": "run", "event": event, "run": None, **more})

    @property
    def _has_policy(self) -> bool:
        section = self._rig.settings.recording
        return section.keep_days > 0.0 or section.keep_GB > 0.0

    async def _do(self, work: Callable[[], str]) -> str:
        """One piece of work, and a line of the log for what it has to say, if anything; that line."""
        try:
            told = await self._aside(work)
        except Exception as error:
            log.exception("the archive could not be looked after")
            self._rig.announce("warn", CODE, f"the archive of runs could not be looked after: {error}")
            return ""
        if told:
            self._rig.announce("info", CODE, told)
        return told

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
        done = recover(self._archive.folder, self._archive.catalogue, _breathe)
        more = f"; and {len(done) - TOLD} more" if len(done) > TOLD else ""
        return "; ".join(each.said for each in done[:TOLD]) + more

    def _prune(self, gone: list[Loose], after: str | None) -> str:
        """Runs that the rig file says are old enough, or too many; they come into `gone`."""
        if after is not None:
            self._archive.recorder.written(after, WRITTEN_WITHIN)
        section = self._rig.settings.recording
        gone += prune(self._archive, Policy(keep_days=section.keep_days, keep_GB=section.keep_GB))
        if not gone:
            return ""
        size = sum(run.size_bytes for run in gone) / MB
        number = "one old run was" if len(gone) == 1 else f"{len(gone)} old runs were"
        return f"{number} deleted ({size:.1f} MB), as [recording] of the rig file says"


_ENDS = {state.value for state in RunState if state is not RunState.RUNNING}


QUIET: Mapping[str, Any] = {"type": "nothing"}
"""What is heeded when nothing has been announced for a while."""


async def _next(messages: Mailbox[dict[str, Any]]) -> Mapping[str, Any]:
    try:
        async with asyncio.timeout(LOOK_AGAIN):
            return await messages.get()
    except TimeoutError:
        return QUIET


def _breathe(*_: int) -> None:
    time.sleep(BREATH)


def _settle(done: asyncio.Future[str], result: str | Exception) -> None:
    if done.done():
        return
    if isinstance(result, Exception):
        done.set_exception(result)
    else:
        done.set_result(result)
