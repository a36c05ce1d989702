"""Notices a tick that does not end: a controller that hangs holds up the thread that would stop it.

The board's own dead-man has zeroed the coils by then; this is for the people who watch, and for a controller
that comes back later and must not find the way to the coils open.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from control.snapshot import ZERO, Fault, RigState, Snapshot

STALL = 0.2
"""A tick that takes longer is looked at, s (faults.md: a stalled loop)."""
LOOK_AGAIN = 0.05
"""Between two looks, s. A computer that is merely busy keeps the watchdog from looking, too."""
LOOKS_AT_A_DECISION = 4
"""In so many looks the same tick waits for its controller: then the controller hangs (0.35 s)."""
LOOKS_AT_A_TICK = 20
"""In so many looks the same tick waits for something else: then the loop hangs (1.15 s)."""


ADVICE = "the coils are off; if it does not come back, restart pivotrig"


@dataclass(frozen=True, slots=True)
class Hang:
    code: str
    reason: str


class Watchdog:
    """deciding: name of the controller that the running tick waits for, "" for none; read from another thread."""

    def __init__(self, deciding: Callable[[], str]) -> None:
        self._deciding = deciding

    async def wait(self, tick: asyncio.Future[Any]) -> Hang | None:
        """Until the tick has ended (None), or it is clear that it hangs."""
        try:
            return await self._watch(tick)
        except asyncio.CancelledError:
            tick.cancel()
            raise

    async def _watch(self, tick: asyncio.Future[Any]) -> Hang | None:
        pause, looks, decisions = STALL, 0, 0
        while not (await asyncio.wait({tick}, timeout=pause))[0]:
            pause, looks = LOOK_AGAIN, looks + 1
            name = self._deciding()
            decisions = decisions + 1 if name else 0
            if decisions >= LOOKS_AT_A_DECISION:
                return Hang("controller", f"controller {name!r} hangs: {ADVICE}")
            if looks >= LOOKS_AT_A_TICK:
                return Hang("stall", f"the control loop stands still: {ADVICE}")
        return None


def stopped(snapshot: Snapshot, hang: Hang) -> Snapshot:
    """What is known once the coils have been stopped and the loop says nothing any more."""
    fault = Fault(hang.code, hang.reason, snapshot.time)
    return replace(
        snapshot,
        rig=RigState.FAULT,
        reason=hang.reason,
        faults=(fault, *snapshot.faults),
        command=replace(snapshot.command, rate=0.0, tilt=0.0, field=0.0),
        currents=ZERO,
        field=ZERO,
        run=None,
    )
