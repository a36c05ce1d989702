"""What people read of the operator's lease."""

from __future__ import annotations

from server.lease.lease import LEASE, TAKE_OVER_AFTER, Asked, Lease, Party, Turn

NOBODY_OPERATES = "Nobody operates the rig; take it with POST /api/v1/operator."
NOBODY_ASKS = "Nobody asks for the rig, so there is nothing to answer."


def absence(party: Party, *, gave_up: bool) -> str:
    """Why a rig is held that nobody looks after."""
    if gave_up:
        return f"{party.name} gave the rig up while it was on; resume it to go on"
    return f"{party.name} operates and has not been heard for {LEASE:g} s; resume to go on"


def forbidden(holder: Turn, now: float) -> str:
    """Why a command of somebody else is refused, and what to do."""
    name, silence = holder.party.name, holder.silence(now)
    if silence > LEASE:
        return (
            f"{name} operates the rig, and has been silent for {silence:.0f} s; take over with "
            "POST /api/v1/operator, then send this again. Anybody may stop."
        )
    return f"{name} operates the rig; ask for it with POST /api/v1/operator. Anybody may stop."


def asked(outcome: Asked, party: Party, before: Lease, now: float) -> str | None:
    """The line of the log, None where nothing has happened."""
    note = f": {party.note}" if party.note else ""
    holder = before.holder
    if outcome is Asked.TAKEN:
        return f"{party.name} operates the rig{note}"
    if outcome is Asked.ASKS:
        return f"{party.name} asks to operate the rig{note}"
    if holder is None or not outcome.holds or outcome is Asked.KEPT:
        return None
    if outcome is Asked.TAKEN_UNANSWERED:
        return (
            f"{party.name} took the rig over from {holder.party.name}, "
            f"who did not answer for {TAKE_OVER_AFTER:g} s{note}"
        )
    silence = holder.silence(now)
    return (
        f"{party.name} took the rig over from {holder.party.name}, who was silent for {silence:.0f} s{note}"
    )


def answered(before: Lease, grant: bool) -> str:
    holder, asker = (turn.party.name if turn else "nobody" for turn in (before.holder, before.asking))
    return (
        f"{holder} handed the rig over to {asker}"
        if grant
        else f"{holder} keeps the rig; {asker} was refused"
    )


def released(party: Party) -> str:
    return f"{party.name} gave the rig up"


def lost(party: Party) -> str:
    return f"{party.name} operates the rig and has not been heard for {LEASE:g} s; anybody may take over"
