"""The operator's lease: one holder, one who asks, and what silence and time do to them; pure, the clock is given.

A term is one holder's time from taking the lease to losing it. Terms are counted, so that a command of a former
term is known as one, even where the same client holds the lease again.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum

LEASE = 2.0
"""A holder who is not heard for longer is silent, s (faults.md: operator lease)."""
TAKE_OVER_AFTER = 10.0
"""Whoever asks and gets no answer for so long may take the lease over, s (time to look up and to answer)."""
ASKING_LAPSES = 30.0
"""Whoever asks and is not heard for so long asks no more, s (three times the time it has to wait)."""


@dataclass(frozen=True, slots=True)
class Party:
    """A client as the others see it. key: known to the server alone.  note: what it is about."""

    key: str
    name: str
    note: str
    is_page: bool


@dataclass(frozen=True, slots=True)
class Turn:
    """Somebody's time as holder, or as the one who asks. since, heard: clock, s."""

    party: Party
    since: float
    heard: float

    def silence(self, now: float) -> float:
        return max(0.0, now - self.heard)


class Asked(StrEnum):
    """What came of asking for the lease."""

    TAKEN = "taken"
    KEPT = "kept"
    ASKS = "asks"
    WAITS = "waits"
    TAKEN_UNANSWERED = "taken, unanswered"
    TAKEN_FROM_SILENT = "taken from a silent holder"

    @property
    def holds(self) -> bool:
        return self not in (Asked.ASKS, Asked.WAITS)


class NotTheHolder(Exception):
    """Only the holder answers, and gives the lease up."""


class NobodyAsks(Exception):
    """There is nothing to answer."""


@dataclass(frozen=True, slots=True)
class Lease:
    """term: 0 before the first holder.  left_by: who gave it up, while nobody has it."""

    term: int = 0
    holder: Turn | None = None
    asking: Turn | None = None
    left_by: Party | None = None

    def is_held_by(self, key: str) -> bool:
        return self.holder is not None and self.holder.party.key == key

    def is_asked_by(self, key: str) -> bool:
        return self.asking is not None and self.asking.party.key == key

    def is_silent(self, now: float) -> bool:
        """There is a holder who is not heard."""
        return self.holder is not None and self.holder.silence(now) > LEASE

    def absent(self, now: float) -> Party | None:
        """Whose work nobody looks after: a silent holder's, or that of one who gave the lease up."""
        if self.holder is None:
            return self.left_by
        return self.holder.party if self.is_silent(now) else None

    def hear(self, key: str, now: float) -> Lease:
        """A sign of life."""
        if self.holder is not None and self.holder.party.key == key:
            return replace(self, holder=replace(self.holder, heard=now))
        if self.asking is not None and self.asking.party.key == key:
            return replace(self, asking=replace(self.asking, heard=now))
        return self

    def without_lapsed(self, now: float) -> Lease:
        """Whoever asked and has gone away asks no more."""
        lapsed = self.asking is not None and self.asking.silence(now) > ASKING_LAPSES
        return replace(self, asking=None) if lapsed else self

    def ask(self, party: Party, now: float) -> tuple[Lease, Asked]:
        """Take it where that is allowed, else ask its holder for it."""
        lease = self.without_lapsed(now)
        if lease.holder is None:
            return lease._taken(party, now), Asked.TAKEN
        if lease.is_held_by(party.key):
            return replace(lease, holder=Turn(party, lease.holder.since, now)), Asked.KEPT
        if lease.is_silent(now):
            return lease._taken(party, now), Asked.TAKEN_FROM_SILENT
        return lease._asked(party, now)

    def answer(self, key: str, grant: bool, now: float) -> Lease:
        """The holder's, to whoever asks; raises `NotTheHolder`, `NobodyAsks`."""
        if not self.is_held_by(key):
            raise NotTheHolder
        if self.asking is None:
            raise NobodyAsks
        return self._taken(self.asking.party, now) if grant else replace(self.hear(key, now), asking=None)

    def release(self, key: str) -> Lease:
        """Nobody has it; raises `NotTheHolder`. Who asks takes it by asking again."""
        if self.holder is None or not self.is_held_by(key):
            raise NotTheHolder
        return replace(self, holder=None, left_by=self.holder.party)

    def withdraw(self, key: str) -> Lease:
        """Whoever asks wants it no more."""
        return replace(self, asking=None) if self.is_asked_by(key) else self

    def _asked(self, party: Party, now: float) -> tuple[Lease, Asked]:
        asking = self.asking
        if asking is None:
            return replace(self, asking=Turn(party, now, now)), Asked.ASKS
        if asking.party.key != party.key:
            return self, Asked.WAITS
        if now - asking.since >= TAKE_OVER_AFTER:
            return self._taken(party, now), Asked.TAKEN_UNANSWERED
        return replace(self, asking=Turn(party, asking.since, now)), Asked.WAITS

    def _taken(self, party: Party, now: float) -> Lease:
        others = self.withdraw(party.key).asking
        return Lease(self.term + 1, Turn(party, now, now), others)
