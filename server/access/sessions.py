"""Who has logged in with a browser. The cookie is random; what is kept of it is a digest, in memory only."""

from __future__ import annotations

import secrets
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass

from server.access.caller import Role
from server.access.tokens import digest_of

IDLE = 12 * 3600.0
"""A session that nobody uses for this long is over, s: a day at the rig, not a night."""
SESSIONS = 1000
"""At most; the one that was used least recently goes first."""


@dataclass(slots=True)
class Session:
    """token: digest of the token that it was opened with; the session ends with that token."""

    role: Role
    token: str
    used: float


class Sessions:
    """clock: monotonic, s."""

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock = clock
        self._open: OrderedDict[str, Session] = OrderedDict()

    def __len__(self) -> int:
        return len(self._open)

    def open(self, role: Role, token: str) -> str:
        """The cookie of a new session; token: its digest."""
        cookie = secrets.token_urlsafe(32)
        self._open[digest_of(cookie)] = Session(role, token, self._clock())
        while len(self._open) > SESSIONS:
            self._open.popitem(last=False)
        return cookie

    def find(self, cookie: str) -> Session | None:
        """The session, which has been used by that."""
        key = digest_of(cookie)
        session = self._open.get(key)
        if session is None:
            return None
        now = self._clock()
        if now - session.used > IDLE:
            del self._open[key]
            return None
        session.used = now
        self._open.move_to_end(key)
        return session

    def close(self, cookie: str) -> None:
        self._open.pop(digest_of(cookie), None)
