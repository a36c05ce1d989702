"""A child process that works on one study: started, listened to, told to stop, and gone when the server goes."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import signal
import sys
from asyncio.subprocess import PIPE, Process
from collections.abc import Callable
from pathlib import Path
from typing import Literal

from control.plugins import loaded_files
from server.exports.formats import IMPOSSIBLE

log = logging.getLogger(__name__)

Verb = Literal["carry-out", "report", "plot", "learned"]
PROGRAM = (sys.executable, "-P", "-m", "server.studies")
"""-P: the folder that somebody works in may have a `server` of its own, which must not be taken for this one."""
LONGEST_LINE = 1 << 20
LAST_WORDS = 2000
"""Characters kept of what it says on its stderr."""
PATIENCE = 10.0
"""A child that was told to stop has written its last row within this time, s; else it is killed."""
FAILED = "the program failed at it; its log says where"


class ChildFailed(Exception):
    """What was wanted of the study cannot be had; the text says why."""


class Child:
    """One process, started by `started`."""

    def __init__(self, process: Process) -> None:
        self._process = process
        self._words = asyncio.create_task(_last_words(process), name="words of a study's process")

    @classmethod
    async def started(cls, verb: Verb, data: Path, id: str, jobs: int = 0) -> Child:
        """jobs: processes that share the work; 0: one a core."""
        files = [str(file) for file in loaded_files()]
        process = await asyncio.create_subprocess_exec(
            *(*PROGRAM, verb, str(jobs), str(data), id, *files),
            stdin=PIPE,
            stdout=PIPE,
            stderr=PIPE,
            limit=LONGEST_LINE,
            start_new_session=True,
        )
        return cls(process)

    async def lines(self, heard: Callable[[bytes], None]) -> None:
        """Until it has ended; raises `ChildFailed`."""
        try:
            while self._process.stdout is not None and (line := await self._process.stdout.readline()):
                heard(line)
            await self._concluded()
        finally:
            await self.kill()

    async def output(self) -> bytes:
        """All that it writes; raises `ChildFailed`."""
        try:
            written = b"" if self._process.stdout is None else await self._process.stdout.read()
            await self._concluded()
            return written
        finally:
            await self.kill()

    async def _concluded(self) -> None:
        status, words = await self._process.wait(), await self._words
        if status == 0:
            return
        if status != IMPOSSIBLE:
            log.error("the process of a study ended with status %d: %s", status, words)
        raise ChildFailed(words if status == IMPOSSIBLE and words else FAILED)

    def interrupt(self) -> None:
        """It finishes what it is writing and ends."""
        with contextlib.suppress(ProcessLookupError):
            self._process.send_signal(signal.SIGINT)

    async def stop(self) -> None:
        """As `interrupt`, and killed when that takes too long."""
        self.interrupt()
        try:
            async with asyncio.timeout(PATIENCE):
                await self._process.wait()
        except TimeoutError:
            await self.kill()

    async def kill(self) -> None:
        with contextlib.suppress(ProcessLookupError):
            self._process.kill()
        await self._process.wait()
        await self._words


async def _last_words(process: Process) -> str:
    """The end of what was said; all of it is taken, so that nobody waits for a reader."""
    said = b""
    while process.stderr is not None and (piece := await process.stderr.read(1 << 16)):
        said = (said + piece)[-LAST_WORDS:]
    return said.decode("utf-8", "replace").strip()
