"""What holds of the operator's lease whatever happens, in whatever order."""

from __future__ import annotations

from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule

from server.lease.lease import (
    ASKING_LAPSES,
    LEASE,
    TAKE_OVER_AFTER,
    Asked,
    Lease,
    NobodyAsks,
    NotTheHolder,
    Party,
)

CLIENTS = [Party(f"key {name}", name, "", name == "page") for name in ("page", "script", "third")]
client = st.sampled_from(CLIENTS)


class Operators(RuleBasedStateMachine):
    """Clients who ask, answer, leave and fall silent, and a clock that goes on."""

    def __init__(self) -> None:
        super().__init__()
        self.lease = Lease()
        self.now = 0.0
        self.terms: dict[int, str] = {}
        self.heard: dict[str, float] = {}
        self.asked_at: dict[str, float] = {}

    def became(self, lease: Lease) -> None:
        """A new term has one holder for good; a term goes on with the same one."""
        before, self.lease = self.lease, lease
        if lease.holder is None:
            return
        key = lease.holder.party.key
        if lease.term == before.term:
            assert before.holder is None or before.holder.party.key == key
        else:
            assert lease.term == before.term + 1
            assert lease.term not in self.terms
        assert self.terms.setdefault(lease.term, key) == key

    @rule(duration=st.sampled_from([0.1, 1.0, LEASE, 2.5, TAKE_OVER_AFTER, ASKING_LAPSES + 1.0]))
    def time_passes(self, duration: float) -> None:
        before = self.lease
        self.now += duration
        assert self.lease is before, "silence alone changes no holder"

    @rule(party=client)
    def is_heard(self, party: Party) -> None:
        lease = self.lease.hear(party.key, self.now)
        assert lease.term == self.lease.term
        self.heard[party.key] = self.now
        self.became(lease)

    @rule(party=client)
    def asks(self, party: Party) -> None:
        before = self.lease
        lease, outcome = before.ask(party, self.now)
        assert outcome.holds is lease.is_held_by(party.key)
        self.became(lease)
        if outcome is Asked.TAKEN_FROM_SILENT:
            assert before.holder is not None
            assert self.now - self.heard[before.holder.party.key] > LEASE
        if outcome is Asked.TAKEN_UNANSWERED:
            assert self.now - self.asked_at[party.key] >= TAKE_OVER_AFTER
        if outcome is Asked.ASKS:
            self.asked_at[party.key] = self.now
        self.heard[party.key] = self.now

    @rule(party=client, grant=st.booleans())
    def answers(self, party: Party, grant: bool) -> None:
        before = self.lease
        try:
            lease = before.answer(party.key, grant, self.now)
        except NotTheHolder:
            assert not before.is_held_by(party.key)
            return
        except NobodyAsks:
            assert before.asking is None
            return
        assert before.is_held_by(party.key)
        assert before.asking is not None
        assert lease.asking is None
        assert lease.is_held_by(before.asking.party.key if grant else party.key)
        self.became(lease)
        if grant:
            self.heard[before.asking.party.key] = self.now
        else:
            self.heard[party.key] = self.now

    @rule(party=client)
    def gives_up(self, party: Party) -> None:
        before = self.lease
        try:
            lease = before.release(party.key)
        except NotTheHolder:
            assert not before.is_held_by(party.key)
            return
        assert lease.holder is None
        assert lease.term == before.term
        assert lease.absent(self.now) == party, "nobody looks after what the former holder has switched on"
        self.became(lease)

    @rule(party=client)
    def wants_it_no_more(self, party: Party) -> None:
        self.became(self.lease.withdraw(party.key))
        assert not self.lease.is_asked_by(party.key)

    @precondition(lambda self: self.lease.holder is not None)
    @rule()
    def silence_is_known(self) -> None:
        holder = self.lease.holder
        assert holder is not None
        silent = self.now - self.heard[holder.party.key] > LEASE
        assert self.lease.is_silent(self.now) is silent
        assert self.lease.absent(self.now) == (holder.party if silent else None)

    @invariant()
    def nobody_asks_himself(self) -> None:
        if self.lease.holder is not None and self.lease.asking is not None:
            assert self.lease.holder.party.key != self.lease.asking.party.key


Operators.TestCase.settings = settings(max_examples=60, stateful_step_count=40, deadline=None)
TestOperators = Operators.TestCase
