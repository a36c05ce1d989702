"""Manual driving: the last jog command, which ages out so that a lost key-up stops the robot."""

from __future__ import annotations

import math
from dataclasses import dataclass

from control.controllers.controller import Decision
from control.model import Pivot

HOLD = 0.3
"""A jog that is not renewed drives for this long at most, s."""


@dataclass(frozen=True, slots=True)
class Jog:
    """pivot: to stand on.  rate: rad/s, signed.  tilt: of the field, rad; None leaves it as it is."""

    pivot: Pivot
    rate: float
    tilt: float | None = None


class Manual:
    """Not a controller to choose for a run: it knows no path, and the rig's loop asks it while none is walked."""

    name = "manual"

    def __init__(self) -> None:
        self._decision: Decision | None = None
        self._until = -math.inf

    def take(self, jog: Jog, now: float) -> None:
        """A jog has come at `now` (s)."""
        self._decision = Decision(jog.pivot, jog.rate)
        self._until = now + HOLD

    def forget(self) -> None:
        """Whatever was asked for is over."""
        self._decision = None

    def decide(self, now: float) -> Decision | None:
        """What to do at `now` (s), None for standing still.

        `sweep` is how far the field may turn until the jog is too old, rad: even a host that dies turns it no further.
        """
        decision, left = self._decision, self._until - now
        if decision is None or not 0.0 < left <= HOLD:
            return None
        return Decision(decision.pivot, decision.rate, abs(decision.rate) * left)
