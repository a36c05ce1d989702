"""The one thread on which everything happens that may block or that changes the rig, one thing after the other."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import asynccontextmanager
from typing import TypeVar

from control.safety import Refused
from server.watchdog import STALL

T = TypeVar("T")


class RigThread:
    """hangs: it does not come back, as its owner has found: what it was asked for will not happen."""

    def __init__(self) -> None:
        self.hangs = False
        self._executor = ThreadPoolExecutor(max_workers=1, thread_name_prefix="rig")
        self._turn = asyncio.Lock()

    @asynccontextmanager
    async def turn(self, within: float | None = None) -> AsyncIterator[None]:
        """Held by the tick that goes on, or by what no tick may interrupt; raises `Refused` after `within` s."""
        try:
            async with asyncio.timeout(within):
                await self._turn.acquire()
        except TimeoutError:
            raise Refused("the control loop does not come back; restart pivotrig") from None
        try:
            yield
        finally:
            self._turn.release()

    def begin(self, work: Callable[[], T]) -> asyncio.Future[T]:
        """Let it be done after all that was asked for before."""
        return asyncio.get_running_loop().run_in_executor(self._executor, work)

    async def call(self, work: Callable[[], T], reason: Callable[[], str]) -> T:
        """Its answer; raises `Refused` with the reason when the thread does not come back."""
        if self.hangs:
            raise Refused(reason())
        answer = self.begin(work)
        while not (await asyncio.wait({answer}, timeout=STALL))[0]:
            if self.hangs:
                answer.cancel()
                raise Refused(reason())
        return answer.result()

    def shutdown(self) -> None:
        """Wait for what goes on, unless it hangs; blocks."""
        self._executor.shutdown(wait=not self.hangs, cancel_futures=True)
