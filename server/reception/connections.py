"""How many connections there may be, and how long one may take to say what it wants and to take its answer.

uvicorn's protocol, with what it leaves open: whoever connects and says nothing, or a header a letter at a time, or
takes nothing of its answer, holds a place for ever, and so may thousands.
"""

from __future__ import annotations

import asyncio
import resource
from functools import lru_cache

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol

from server.access.addresses import is_loopback, site_of

PLACES = 400
"""Connections in all: a hundred dashboards of three sockets each, and their requests."""
PLACES_OF_ONE = 150
"""Of one site: a lab behind one address. This computer's own programs, and a proxy's callers, have all of them."""
HEADER_TIME = 10.0
"""Time from the first word of a request, or from connecting, to the end of its header, s."""
IDLE_TIME = 15
"""How long a connection may wait for its next request, s."""
TAKEN_WITHIN = 60.0
"""Time within which a client must have taken a part of what waits for it, s."""
FILES = 4096
"""Files and sockets that the program may have open: all places, and what it works with."""

FULL = (
    b"HTTP/1.1 503 Service Unavailable\r\nContent-Type: text/plain\r\nContent-Length: 42\r\nRetry-After: 10\r\n"
    b"Connection: close\r\n\r\nToo many connections; try again in a while"
)

known_site = lru_cache(maxsize=1000)(site_of)


class PatientProtocol(H11Protocol):
    """Refuses what is too many, and closes what is too slow."""

    _deadline: asyncio.TimerHandle | None = None
    _patience: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        super().connection_made(transport)
        if self._is_one_too_many():
            transport.write(FULL)
            transport.close()
            return
        self._expect()

    def data_received(self, data: bytes) -> None:
        super().data_received(data)
        if self.transport.get_protocol() is not self or self.conn.their_state is not h11.IDLE:
            self._expect_nothing()
        elif self._deadline is None and not self.transport.is_closing():
            self._expect()

    def connection_lost(self, exc: Exception | None) -> None:
        self._expect_nothing()
        self._await_no_taking()
        super().connection_lost(exc)

    def pause_writing(self) -> None:
        super().pause_writing()
        self._await_taking()

    def resume_writing(self) -> None:
        super().resume_writing()
        self._await_no_taking()

    def _is_one_too_many(self) -> bool:
        if len(self.connections) > PLACES:
            return True
        if self.client is None or is_loopback(self.client[0]):
            return False
        site = known_site(self.client[0])
        clients = (each.client for each in self.connections)  # type: ignore[attr-defined]
        return sum(known_site(client[0]) == site for client in clients if client) > PLACES_OF_ONE

    def _expect(self) -> None:
        self._deadline = self.loop.call_later(HEADER_TIME, self.transport.close)

    def _expect_nothing(self) -> None:
        if self._deadline is not None:
            self._deadline.cancel()
            self._deadline = None

    def _await_taking(self) -> None:
        waiting = self.transport.get_write_buffer_size()
        self._patience = self.loop.call_later(TAKEN_WITHIN, self._lose_patience, waiting)

    def _lose_patience(self, waiting: int) -> None:
        if self.transport.get_write_buffer_size() < waiting:
            self._await_taking()
        else:
            self.transport.abort()

    def _await_no_taking(self) -> None:
        if self._patience is not None:
            self._patience.cancel()
            self._patience = None


def allow_files() -> None:
    """Raise the limit of open files as far as it is needed and allowed."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = FILES if hard == resource.RLIM_INFINITY else min(FILES, hard)
    if soft != resource.RLIM_INFINITY and soft < wanted:
        resource.setrlimit(resource.RLIMIT_NOFILE, (wanted, hard))
