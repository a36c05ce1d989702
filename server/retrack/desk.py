"""Runs that are looked at again for the page: one at a time, in a process of its own."""

from __future__ import annotations

import asyncio
import contextlib
import itertools
import logging
import sys
from asyncio.subprocess import PIPE, Process
from collections import OrderedDict
from dataclasses import dataclass, field
from pathlib import Path

import msgspec

from control.plugins import loaded_files
from server.exports.formats import IMPOSSIBLE
from server.retrack.changes import Changes
from server.retrack.order import Order, Said

log = logging.getLogger(__name__)

LONGEST_LINE = 16 << 20
"""Bytes of the result: 2 000 points have less than 1 MB."""
KEPT = 4
"""Results that are kept, of the runs that were looked at last."""
FAILED = "the program failed at it; its log says where"


class Busy(Exception):
    """Another run is being looked at."""


@dataclass(slots=True)
class Job:
    """stage: "none", "working", "done", "failed" or "cancelled", and why in `reason`.  progress: 0 to 1."""

    id: int
    run: str
    stage: str = "working"
    progress: float = 0.0
    reason: str = ""
    result: Said | None = field(default=None, repr=False)


class RetrackDesk:
    """Belongs to the event loop."""

    def __init__(self) -> None:
        self._jobs: OrderedDict[str, Job] = OrderedDict()
        self._work: asyncio.Task[None] | None = None
        self._numbers = itertools.count(1)

    def of(self, run: str) -> Job | None:
        """What became of this run's; None where there was none, or it is long ago."""
        return self._jobs.get(run)

    @property
    def working(self) -> Job | None:
        return next((job for job in self._jobs.values() if job.stage == "working"), None)

    def start(self, run: str, path: Path, changes: Changes) -> Job:
        """Look at that recording; raises `Busy`. The run's last result is forgotten."""
        if self.working is not None:
            raise Busy(
                f"the run {self.working.run} is being looked at again; wait for it, or cancel that first"
            )
        job = Job(next(self._numbers), run)
        self._jobs.pop(run, None)
        self._jobs[run] = job
        while len(self._jobs) > KEPT:
            self._jobs.popitem(last=False)
        self._work = asyncio.create_task(self._done(job, path, changes), name=f"re-track of {run}")
        return job

    async def cancel(self, run: str) -> Job | None:
        """End the work on this run, or forget its result."""
        job = self._jobs.get(run)
        if job is None:
            return None
        if job.stage != "working":
            del self._jobs[run]
            return job
        await self.stop()
        return job

    async def stop(self) -> None:
        """End what is being worked on; nothing is left of it."""
        work, self._work = self._work, None
        if work is not None:
            work.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await work

    async def _done(self, job: Job, path: Path, changes: Changes) -> None:
        try:
            await self._worked(job, path, changes)
        except asyncio.CancelledError:
            job.stage, job.reason = "cancelled", "cancelled"
            raise
        except Exception:
            log.exception("the run %s cannot be looked at again", job.run)
            job.stage, job.reason = "failed", FAILED

    async def _worked(self, job: Job, path: Path, changes: Changes) -> None:
        process = await asyncio.create_subprocess_exec(
            *(sys.executable, "-P", "-m", "server.retrack", str(path)),
            stdin=PIPE,
            stdout=PIPE,
            stderr=PIPE,
            limit=LONGEST_LINE,
            start_new_session=True,
        )
        try:
            order = Order(changes.to_json(), [str(file) for file in loaded_files()])
            _, words, _ = await asyncio.gather(
                _ordered(process, msgspec.json.encode(order)), _last_words(process), _heard(process, job)
            )
            _conclude(job, await process.wait(), words)
        finally:
            with contextlib.suppress(ProcessLookupError):
                process.kill()
            await process.wait()


async def _ordered(process: Process, order: bytes) -> None:
    if process.stdin is not None:
        with contextlib.suppress(BrokenPipeError, ConnectionResetError):  # it has ended, and says why
            process.stdin.write(order)
            await process.stdin.drain()
        process.stdin.close()


async def _heard(process: Process, job: Job) -> None:
    while process.stdout is not None and (line := await process.stdout.readline()):
        said = msgspec.json.decode(line, type=Said)
        job.progress = said.progress
        if bytes(said.comparison):
            job.result = said


async def _last_words(process: Process) -> str:
    said = b"" if process.stderr is None else await process.stderr.read()
    return said[-2000:].decode("utf-8", "replace").strip()


def _conclude(job: Job, status: int, words: str) -> None:
    if status == 0 and job.result is not None:
        job.stage, job.progress = "done", 1.0
        return
    job.stage, job.reason = "failed", words if status == IMPOSSIBLE else FAILED
    if status != IMPOSSIBLE:
        log.error("the re-track of %s ended with status %d: %s", job.run, status, words)
