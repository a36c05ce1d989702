"""Whether the program does what it is there for: its loop ticks."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from server.rig import Rig
    from server.watching.tally import RigTally

SILENT = 2.0
"""A loop without a tick for this long, s, is not one that is late: a tick happens at least every 34 ms, and the
exchange of a machine with a slow camera takes a second."""


class Pulse:
    """clock: monotonic, s."""

    def __init__(self, rig: Rig, ticks: RigTally, clock: Callable[[], float] = time.monotonic) -> None:
        self._rig = rig
        self._ticks = ticks
        self._clock = clock
        self._started = clock()

    def begin(self) -> None:
        """The rig is open: ticks are expected from now on."""
        self._started = self._clock()

    @property
    def failing(self) -> str:
        """What is wrong with the program itself, or "". A rig in the fault state is a program that works."""
        if self._rig.failure is not None:
            return self._rig.snapshot.reason
        if self._rig.hangs:
            return "the control loop does not come back"
        silent = self._clock() - max(self._started, self._ticks.last_at)
        return f"the control loop has not ticked for {silent:.0f} s" if silent > SILENT else ""
