"""All replays that are open: a few at once, each as long as its page holds on to it."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager
from pathlib import Path

from server.replay.session import ReplaySession
from server.scene.geometry import SceneGeometry

MOST_SESSIONS = 6
"""Replays at once. Each holds a thread and a few MB, and its scene some more."""


class TooManyReplays(Exception):
    """As many replays are open as there may be."""

    def __init__(self) -> None:
        super().__init__(f"{MOST_SESSIONS} replays are open already; close one of them first")


class ReplaySessions:
    def __init__(self) -> None:
        self._sessions: dict[str, ReplaySession] = {}

    def __len__(self) -> int:
        return len(self._sessions)

    def find(self, id: str) -> ReplaySession | None:
        return self._sessions.get(id)

    @asynccontextmanager
    async def opened(
        self, names: Sequence[str], paths: Sequence[Path], fallback: SceneGeometry
    ) -> AsyncIterator[ReplaySession]:
        """A session of these recordings, for as long as the context lasts; raises `TooManyReplays`, `Unreadable`."""
        if len(self._sessions) >= MOST_SESSIONS:
            raise TooManyReplays
        session = ReplaySession(names, fallback)
        self._sessions[session.id] = session
        try:
            await session.open(paths)
            yield session
        finally:
            await asyncio.shield(self._end(session))

    async def _end(self, session: ReplaySession) -> None:
        """It counts until it is gone, so that there are never more than there may be."""
        try:
            await session.close()
        finally:
            del self._sessions[session.id]
