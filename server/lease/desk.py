"""The lease of one rig: who is heard, what everybody is told, and which commands may still take effect.

The lease changes on the event loop only. The rig's thread reads it: one immutable value after the other, so it
sees the former or the new one and nothing between.
"""

from __future__ import annotations

import asyncio
import contextlib
import hashlib
import secrets
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from control.snapshot import RigState
from server.api.problems import Problem, Rejected
from server.lease import words
from server.lease.lease import LEASE, TAKE_OVER_AFTER, Asked, Lease, NobodyAsks, NotTheHolder, Party, Turn

if TYPE_CHECKING:
    from server.access.caller import Caller
    from server.rig import Rig

EVENT = "operator"
"""Code of the lease's entries in the event log."""
LOOK_EVERY = 0.2
"""How often it is looked whether somebody has become silent, s; a tenth of the lease."""
ID_BYTES = 6
"""Of a client's public name; two of some hundred clients never have the same."""
NAME_LENGTH = 60
NOTE_LENGTH = 200
"""Characters of what a client says of itself."""

YOU_MAY = {1: "view", 2: "operate", 3: "administer"}


@dataclass(frozen=True, slots=True)
class Hand:
    """The right to command in one term of the lease."""

    desk: LeaseDesk
    key: str
    term: int

    def require(self) -> None:
        """Raises `Rejected` where the term is over; asked where and when a command takes effect, on any thread."""
        lease = self.desk.lease
        if lease.term != self.term or not lease.is_held_by(self.key):
            raise self.desk.too_late(self.key)


class LeaseDesk:
    """lease: as it is now.  clock: monotonic, s."""

    def __init__(self, rig: Rig, clock: Callable[[], float] = time.monotonic) -> None:
        self.lease = Lease()
        self._rig = rig
        self._clock = clock
        self._secret = secrets.token_bytes(16)
        self._was_silent = False
        self._task: asyncio.Task[None] | None = None

    def start(self) -> None:
        """Begin to look after the rig's operator; ends with `stop`."""
        self._task = asyncio.create_task(self._look_for_ever(), name="operator lease")

    async def stop(self) -> None:
        if self._task is not None:
            self._task.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await self._task

    # Whoever is heard ----------------------------------------------------------------------------

    def hear(self, caller: Caller) -> None:
        """A sign of life of that client."""
        self.lease = self.lease.hear(key_of(caller), self._clock())
        self._look()

    def absence(self, walking: bool) -> str:
        """As `Attendance` has it: a script's run is held, and all that a page has switched on."""
        lease = self.lease
        party = lease.absent(self._clock())
        if party is None or not (walking or party.is_page):
            return ""
        return words.absence(party, gave_up=lease.holder is None)

    # Commands ------------------------------------------------------------------------------------

    def hand(self, caller: Caller) -> Hand:
        """To command with; a free lease is taken, and so is that of a silent holder while nothing is switched on: a
        script that has ended keeps no rig from the next one. Raises `Rejected` where somebody else has it."""
        key, now = key_of(caller), self._clock()
        is_idle = self._rig.snapshot.rig is RigState.DISARMED
        if self.lease.holder is None or (is_idle and self.lease.is_silent(now)):
            self.ask(caller)
        elif not self.lease.is_held_by(key):
            raise self._somebody_else(self.lease.holder)
        self.lease = self.lease.hear(key, now)
        self._look()
        return Hand(self, key, self.lease.term)

    def too_late(self, key: str) -> Rejected:
        holder = self.lease.holder
        if holder is not None and holder.party.key != key:
            return self._somebody_else(holder)
        detail = (
            "This command belongs to an earlier turn of yours as operator; nothing was done. Send it again."
        )
        return Rejected(Problem(409, "Too late", detail, members={"holder": self._turn_json(holder)}))

    def _somebody_else(self, holder: Turn) -> Rejected:
        detail = words.forbidden(holder, self._clock())
        return Rejected(
            Problem(409, "Somebody else operates", detail, members={"holder": self._turn_json(holder)})
        )

    # Taking, asking, answering -------------------------------------------------------------------

    def ask(self, caller: Caller, name: str = "", note: str = "") -> Asked:
        """Take the lease, or ask for it."""
        before, now = self.lease, self._clock()
        known = before.holder if before.is_held_by(key_of(caller)) else None
        party = party_of(caller, name or (known.party.name if known else ""), note)
        self.lease, outcome = before.ask(party, now)
        if (line := words.asked(outcome, party, before, now)) is not None:
            self._rig.announce("info", EVENT, line)
        if self.lease != before:
            self._tell()
        return outcome

    def answer(self, caller: Caller, *, grant: bool) -> None:
        """The holder's, to whoever asks; raises `Rejected`."""
        before = self.lease
        with self._refusals():
            self.lease = before.answer(key_of(caller), grant, self._clock())
        self._rig.announce("info", EVENT, words.answered(before, grant))
        self._tell()

    def release(self, caller: Caller) -> None:
        """The holder gives it up; whoever asks asks no more; nothing to do for anybody else."""
        before, key = self.lease, key_of(caller)
        if before.holder is not None and before.is_held_by(key):
            self.lease = before.release(key)
            self._rig.announce("info", EVENT, words.released(before.holder.party))
        elif before.is_asked_by(key):
            self.lease = before.withdraw(key)
        else:
            return
        self._tell()

    @contextlib.contextmanager
    def _refusals(self) -> Iterator[None]:
        try:
            yield
        except NotTheHolder:
            holder = self.lease.holder
            if holder is not None:
                raise self._somebody_else(holder) from None
            raise Rejected(Problem(409, "Nobody operates", words.NOBODY_OPERATES)) from None
        except NobodyAsks:
            raise Rejected(Problem(409, "Nobody asks", words.NOBODY_ASKS)) from None

    # What everybody is told ----------------------------------------------------------------------

    def public(self) -> dict[str, Any]:
        """Who holds the lease and who asks for it."""
        lease = self.lease.without_lapsed(self._clock())
        return {"holder": self._turn_json(lease.holder), "asking": self._asking_json(lease.asking)}

    def to(self, caller: Caller) -> dict[str, Any]:
        """The same for one client, with what it is here."""
        return {**self.public(), **self.you(caller), "lease_s": LEASE, "take_over_after_s": TAKE_OVER_AFTER}

    def you(self, caller: Caller) -> dict[str, Any]:
        return {"you": self.id_of(key_of(caller)), "you_may": YOU_MAY[caller.role]}

    def in_state(self) -> dict[str, Any] | None:
        """The holder as each tick shows it."""
        holder = self.lease.holder
        if holder is None:
            return None
        return {"id": self.id_of(holder.party.key), "name": holder.party.name, "note": holder.party.note}

    def id_of(self, key: str) -> str:
        """A client's public name; its own one cannot be found out from it."""
        return hashlib.blake2b(key.encode(), key=self._secret, digest_size=ID_BYTES).hexdigest()

    def _turn_json(self, turn: Turn | None) -> dict[str, Any] | None:
        if turn is None:
            return None
        kind = {"kind": "page" if turn.party.is_page else "script"}
        return {**self._asks_json(turn), **kind, "silent_s": round(turn.silence(self._clock()), 2)}

    def _asking_json(self, turn: Turn | None) -> dict[str, Any] | None:
        return None if turn is None else self._asks_json(turn)

    def _asks_json(self, turn: Turn) -> dict[str, Any]:
        party = turn.party
        since = round(max(0.0, self._clock() - turn.since), 2)
        return {"id": self.id_of(party.key), "name": party.name, "note": party.note, "since_s": since}

    def _tell(self) -> None:
        self._rig.announcements.publish({"type": "operator", **self.public()})

    # Silence -------------------------------------------------------------------------------------

    async def _look_for_ever(self) -> None:
        while True:
            await asyncio.sleep(LOOK_EVERY)
            self._look()

    def _look(self) -> None:
        """Tell of a holder who has become silent, or is heard again, and of somebody who asks no more."""
        before, now = self.lease, self._clock()
        self.lease = before.without_lapsed(now)
        is_silent = self.lease.is_silent(now)
        changed = is_silent != self._was_silent or self.lease.asking is not before.asking
        if is_silent and not self._was_silent and before.holder is not None:
            self._rig.announce("warn", EVENT, words.lost(before.holder.party))
        self._was_silent = is_silent
        if changed:
            self._tell()


def is_heard(caller: Caller) -> bool:
    """Whether any request of it is a sign of life: a script's is, a page's goes on where nobody looks."""
    return not caller.from_page


def key_of(caller: Caller) -> str:
    """A page without a name of its own is not the script at the same address."""
    return f"{caller.key}\npage" if caller.from_page and not caller.client else caller.key


def party_of(caller: Caller, name: str = "", note: str = "") -> Party:
    """With the name that the client gives itself, or the one it is known by."""
    script = caller.client or f"script at {caller.address}"
    known = f"Dashboard at {caller.address}" if caller.from_page else script
    return Party(key_of(caller), (name or known)[:NAME_LENGTH], note[:NOTE_LENGTH], caller.from_page)
