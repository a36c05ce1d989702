"""Jogs in the order in which they were sent: one that was overtaken on its way starts nothing again."""

from __future__ import annotations

from control.safety import Refused

HANDS = 32
"""Hands that are remembered; more than there are people at one rig within a jog's 300 ms."""
OVERTAKEN = "this jog has been overtaken by a newer one of the same hand, and nothing was done"


class JogOrder:
    """The newest number of each hand."""

    def __init__(self) -> None:
        self._newest: dict[str, int] = {}

    def take(self, hand: str, number: int) -> None:
        """A jog of `hand` has come; raises `Refused` where a later one came before it."""
        newest = self._newest.pop(hand, -1)
        self._newest[hand] = max(newest, number)
        while len(self._newest) > HANDS:
            del self._newest[next(iter(self._newest))]
        if number <= newest:
            raise Refused(OVERTAKEN)
