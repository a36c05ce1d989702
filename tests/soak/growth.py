"""Does it grow? The server's memory at the end of a soak against what it was when everything had happened once."""

from __future__ import annotations

import statistics
from collections.abc import Sequence
from dataclasses import dataclass

from tests.soak.broken import InvariantBroken
from tests.soak.process import Memory

WARM = 300.0
"""Minute five, s: each kind of fault, export and replay has been there, and what they load is loaded."""
AROUND = 60.0
"""Length of the stretches that are compared, s: one look may meet an export."""
ALLOWED = 0.05
"""Share of growth (the target of the soak)."""
JUDGED_FROM = 2.0 * WARM
"""A shorter soak shows its memory and judges nothing, s."""


@dataclass(frozen=True, slots=True)
class Look:
    """at: since the beginning, s."""

    at: float
    memory: Memory


@dataclass(frozen=True, slots=True)
class Growth:
    """Medians, bytes. is_judged: the soak was long enough."""

    warm: Memory
    last: Memory
    is_judged: bool

    @property
    def share(self) -> float:
        return self.last.held / self.warm.held - 1.0

    def check(self) -> None:
        if self.is_judged and self.share > ALLOWED:
            raise InvariantBroken(
                f"memory: {self.last.held / 1e6:.0f} MB at the end, {self.warm.held / 1e6:.0f} MB at minute five: "
                f"{100 * self.share:+.1f} %, where {100 * ALLOWED:.0f} % are allowed"
            )


def growth_of(looks: Sequence[Look]) -> Growth:
    """In a shorter soak the middle stands for minute five."""
    end = looks[-1].at
    is_judged = end >= JUDGED_FROM
    warm = WARM if is_judged else end / 2.0
    around = AROUND if is_judged else end / 4.0
    early = [look.memory for look in looks if abs(look.at - warm) <= around / 2.0]
    late = [look.memory for look in looks if look.at >= end - around]
    return Growth(_median(early or late), _median(late), is_judged)


def _median(memories: Sequence[Memory]) -> Memory:
    return Memory(
        round(statistics.median(memory.held for memory in memories)),
        round(statistics.median(memory.anonymous for memory in memories)),
    )
