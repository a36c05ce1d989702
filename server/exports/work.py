"""Exports as processes of their own: the server only passes on what they write, and ends them when it likes."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import sys
from asyncio.subprocess import DEVNULL, PIPE, Process
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from server.exports.formats import IMPOSSIBLE, ExportError, Job

log = logging.getLogger(__name__)

PIECE = 1 << 16
"""Bytes passed on at once."""
LAST_WORDS = 2000
"""Characters kept of what an export says on its stderr."""
PROGRAM = (sys.executable, "-P", "-m", "server.exports")
"""-P: the folder that somebody works in may have a `server` of its own, which must not be taken for this one."""
AT_ONCE = 2
"""Exports that may work at the same time; a further one waits for its turn."""


class Workshop:
    """Where the exports of one server are made."""

    def __init__(self) -> None:
        self._seats = asyncio.Semaphore(AT_ONCE)

    @asynccontextmanager
    async def making(self, job: Job) -> AsyncIterator[AsyncIterator[bytes]]:
        """The pieces of the file while it is made. Leaving the context ends the work, done or not."""
        async with self._seats:
            process = await asyncio.create_subprocess_exec(
                *_command(job), stdin=DEVNULL, stdout=PIPE, stderr=PIPE, start_new_session=True
            )
            words = asyncio.create_task(_last_words(_stream(process.stderr)))
            try:
                yield _pieces(process, words)
            finally:
                await _end(process)
                await words


def _command(job: Job) -> list[str]:
    overlay = ["--overlay"] if job.overlay else []
    return [*PROGRAM, job.format, str(job.path), *overlay]


def _stream(pipe: asyncio.StreamReader | None) -> asyncio.StreamReader:
    if pipe is None:
        raise RuntimeError("the export was started without its pipes")
    return pipe


async def _pieces(process: Process, words: asyncio.Task[str]) -> AsyncIterator[bytes]:
    """Raises `ExportError`, with the export's own words where it has some, when it fails at whatever point."""
    while piece := await _stream(process.stdout).read(PIECE):
        yield piece
    status = await process.wait()
    if status == IMPOSSIBLE:
        raise ExportError(await words)
    if status != 0:
        log.error("an export ended with status %d: %s", status, await words)
        raise ExportError("the recording cannot be exported: the program failed at it; its log says where")


async def _last_words(stderr: asyncio.StreamReader) -> str:
    """The end of what was said; all of it is taken, so that nobody waits for a reader."""
    said = b""
    while piece := await stderr.read(PIECE):
        said = (said + piece)[-LAST_WORDS:]
    return said.decode("utf-8", "replace").strip()


async def _end(process: Process) -> None:
    with contextlib.suppress(ProcessLookupError):
        process.kill()
    while await _stream(process.stdout).read(PIECE):  # what it had written and nobody took
        continue
    await process.wait()
