"""Last-value slots between the loop and its watchers: a slow reader loses values, nobody waits for it."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import AsyncIterator, Awaitable, Callable, Coroutine
from contextlib import asynccontextmanager
from typing import Any, Generic, TypeVar

T = TypeVar("T")


class StreamEnded(Exception):
    """The publisher has closed: there will be no further value."""


class Mailbox(Generic[T]):
    """What one reader has yet to read: at most `depth` values, of which the oldest fall out."""

    def __init__(self, depth: int) -> None:
        self._values: deque[T] = deque(maxlen=depth)
        self._changed = asyncio.Event()
        self._closed = False

    def put(self, value: T) -> None:
        self._values.append(value)
        self._changed.set()

    def close(self) -> None:
        self._closed = True
        self._changed.set()

    async def get(self) -> T:
        """The next value, waiting for one if need be; raises StreamEnded once the publisher has closed."""
        while not self._values:
            if self._closed:
                raise StreamEnded
            self._changed.clear()
            await self._changed.wait()
        return self._values.popleft()


class Publisher(Generic[T]):
    """Hands each value to every subscriber's own mailbox; to be used on the event loop only.

    depth: how many values wait for a reader (1 = the newest only).
    replay: whether a newcomer finds the last published value in its mailbox.
    """

    def __init__(self, depth: int = 1, *, replay: bool = True) -> None:
        self._depth = depth
        self._replay = replay
        self._last: deque[T] = deque(maxlen=1)
        self._mailboxes: set[Mailbox[T]] = set()
        self._closed = asyncio.Event()

    @property
    def subscribers(self) -> int:
        return len(self._mailboxes)

    @property
    def closed(self) -> bool:
        return self._closed.is_set()

    async def wait_closed(self) -> None:
        await self._closed.wait()

    def publish(self, value: T) -> None:
        """Nobody gets what is published after the end."""
        if self.closed:
            return
        if self._replay:
            self._last.append(value)
        for mailbox in self._mailboxes:
            mailbox.put(value)

    def close(self) -> None:
        """End every stream: readers get StreamEnded, so that no open connection holds up a shutdown."""
        self._closed.set()
        for mailbox in self._mailboxes:
            mailbox.close()

    @asynccontextmanager
    async def subscribe(self) -> AsyncIterator[Mailbox[T]]:
        mailbox = Mailbox[T](self._depth)
        for value in self._last:
            mailbox.put(value)
        if self.closed:
            mailbox.close()
        self._mailboxes.add(mailbox)
        try:
            yield mailbox
        finally:
            self._mailboxes.discard(mailbox)


ANNOUNCEMENT_DEPTH = 100
"""Events that wait for one client before the oldest are dropped; a minute of a very busy event log."""


def announcer() -> Publisher[dict[str, Any]]:
    """A publisher of events, of which a reader may fall behind by some but must not miss each second one."""
    return Publisher(depth=ANNOUNCEMENT_DEPTH, replay=False)


class Cadence:
    """Keeps a stream at or below a rate without shifting its beat.

    period: shortest mean time between values, s.  clock: a monotonic clock, s.
    """

    def __init__(self, period: float, clock: Callable[[], float], sleep: Callable[[float], Awaitable[None]]):
        self._period = period
        self._clock = clock
        self._sleep = sleep
        self._due = clock()

    async def wait(self) -> None:
        """Return when the next value is due; after a pause the beat starts anew instead of catching up."""
        now = self._clock()
        if now < self._due:
            await self._sleep(self._due - now)
            now = self._due
        self._due = max(self._due + self._period, now)


async def until_first_ends(*work: Coroutine[Any, Any, None]) -> None:
    """Run the coroutines side by side until one of them ends, then cancel the rest and wait for them.

    An error of the one that ended first is raised; cancelling this cancels all of them.
    """
    tasks = [asyncio.create_task(each) for each in work]
    try:
        done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
    for task in done:
        task.result()
