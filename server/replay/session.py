"""One page's replay of one or two recordings: what it asks for, on a thread of its own, and its scene."""

from __future__ import annotations

import asyncio
import secrets
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, TypeVar

from server.recording.reading.recording import Picture
from server.replay.player import Player
from server.replay.shown import Instant, ReplaySource
from server.replay.staging import stage
from server.scene.feed import SceneFeed
from server.scene.geometry import SceneGeometry
from server.scene.robot import LOOKS, Looks
from server.streams import Publisher, StreamEnded

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Film:
    """A picture of a recording and the tick that was made of it."""

    picture: Picture
    tick: dict[str, Any] | None


@dataclass(frozen=True, slots=True)
class Shot:
    """The answer to one request. films: of each recording, None where there is none yet or none were asked for."""

    instant: Instant
    films: Sequence[Film | None] | None = field(repr=False)


class ReplaySession:
    """Open it, ask it, close it."""

    def __init__(self, names: Sequence[str], fallback: SceneGeometry) -> None:
        """names: what people call the runs.  fallback: drawn for a recording that has lost what its rig was."""
        self.id = secrets.token_hex(8)
        self._names = tuple(names)
        self._fallback = fallback
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="replay")
        self._players: list[Player] = []
        self._shown: Publisher[Instant] = Publisher()
        self._scene: SceneFeed[Instant] | None = None
        self._one_at_a_time = asyncio.Lock()
        self._newest: Picture | None = None
        """Of the first recording: the picture that was shown last."""

    async def open(self, paths: Sequence[Path]) -> None:
        """Raises `Unreadable`."""
        await self._on_thread(self._open, paths)

    def _open(self, paths: Sequence[Path]) -> None:
        for path in paths:
            self._players.append(Player(path))

    @property
    def durations(self) -> list[float]:
        """Of the recordings, s."""
        return [player.duration for player in self._players]

    async def shot(self, at: float, *, pictures: bool) -> Shot:
        """What there was `at` s after the runs' start; the scene shows it too. Raises `Unreadable`."""
        shot = await self._on_thread(self._shot, at, pictures)
        if shot.films and shot.films[0] is not None:
            self._newest = shot.films[0].picture
        self._shown.publish(shot.instant)
        return shot

    def _shot(self, at: float, pictures: bool) -> Shot:
        instant = Instant(at, [player.tick_at(at) for player in self._players])
        return Shot(instant, [film_at(player, at) for player in self._players] if pictures else None)

    async def scene(self) -> SceneFeed[Instant]:
        """Of this replay; it starts when it is asked for. Raises `StreamEnded` once the replay is over."""
        async with self._one_at_a_time:
            if self._shown.closed:
                raise StreamEnded
            if self._scene is None:
                source = await self._on_thread(self._source)
                self._scene = SceneFeed(self._shown, source, looks_of(self._names))
                await self._scene.start()
            return self._scene

    def _source(self) -> ReplaySource:
        return stage([player.recording for player in self._players], self._fallback, lambda: self._newest)

    async def close(self) -> None:
        self._shown.close()
        async with self._one_at_a_time:
            if self._scene is not None:
                await self._scene.stop()
        await self._on_thread(self._close)
        self._thread.shutdown()

    def _close(self) -> None:
        for player in self._players:
            player.close()

    async def _on_thread(self, work: Callable[..., T], *what: Any) -> T:
        return await asyncio.get_running_loop().run_in_executor(self._thread, work, *what)


def film_at(player: Player, at: float) -> Film | None:
    """The newest picture, and the tick that came of it: the one that its overlay is drawn from."""
    picture = player.picture_at(at)
    return None if picture is None else Film(picture, player.tick_of(picture))


def looks_of(names: Sequence[str]) -> list[Looks]:
    """The first run looks as the rig does; the one that it is compared with has its name beside it."""
    first, other = LOOKS
    return [first, *(replace(other, label=name) for name in names[1:])]
