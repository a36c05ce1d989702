"""The answer to a request for an export: the file while it is made, or a problem document in its place."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import AsyncIterator, Awaitable, Callable, Mapping

from starlette.responses import Response
from starlette.types import Receive, Scope, Send

from server.api.problems import Problem
from server.exports.formats import ExportError, Job
from server.exports.work import Workshop
from server.streams import until_first_ends

log = logging.getLogger(__name__)

STALLED = 60.0
"""A client that takes nothing for this long has given up, s."""
GOING_DOWN = Problem(503, "Going down", "The server is going down; ask again when it is back.")
"""For an export that was to begin; a client that has gone does not hear it."""


class Download(Response):
    """Ends with its client, and with the server, also before the first byte has come."""

    def __init__(
        self,
        workshop: Workshop,
        job: Job,
        over: Callable[[], Awaitable[None]],
        headers: Mapping[str, str],
    ) -> None:
        """over: returns when the server ends.  headers: of the file."""
        super().__init__(headers=headers)
        del self.headers["content-length"]  # nobody knows it before the end
        self._workshop = workshop
        self._job = job
        self._over = over
        self._begun = False

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        await until_first_ends(self._deliver(scope, receive, send), _gone(receive), self._server_ends())
        if not self._begun:
            await GOING_DOWN.response()(scope, receive, send)

    async def _server_ends(self) -> None:
        await self._over()

    async def _deliver(self, scope: Scope, receive: Receive, send: Send) -> None:
        async with self._workshop.making(self._job) as pieces:
            try:
                first = await anext(pieces, b"")
            except ExportError as error:
                self._begun = True
                await Problem(409, "Cannot be exported", str(error)).response()(scope, receive, send)
                return
            try:
                await self._send(first, pieces, send)
            except ExportError as error:
                # The answer has begun: only an end that is not one tells the client that something is missing.
                log.error("the export of %s as %s broke off: %s", self._job.path, self._job.format, error)
            except TimeoutError:
                log.info("a client took nothing of a %s for %g s and was dropped", self._job.format, STALLED)

    async def _send(self, first: bytes, pieces: AsyncIterator[bytes], send: Send) -> None:
        self._begun = True
        await send({"type": "http.response.start", "status": 200, "headers": self.raw_headers})
        await _in_time(send, first)
        async for piece in pieces:
            await _in_time(send, piece)
        await send({"type": "http.response.body", "body": b"", "more_body": False})


async def _in_time(send: Send, piece: bytes) -> None:
    async with asyncio.timeout(STALLED):
        await send({"type": "http.response.body", "body": piece, "more_body": True})


async def _gone(receive: Receive) -> None:
    """Returns when the client has gone."""
    while (await receive())["type"] != "http.disconnect":
        continue
