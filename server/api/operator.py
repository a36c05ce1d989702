"""Who operates the rig: one client at a time. Everybody else watches, may stop, and may ask for it."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from fastapi import APIRouter, Depends, Response
from pydantic import AfterValidator, Field
from starlette.requests import HTTPConnection

from server.access.caller import TheCaller
from server.api.body import StrictRoute
from server.api.schemas import Edge
from server.lease.desk import NAME_LENGTH, NOTE_LENGTH, Hand, LeaseDesk, is_heard

router = APIRouter(prefix="/operator", tags=["operator"], route_class=StrictRoute)

ACCEPTED = 202
OPEN = frozenset({"/api/v1/health", "/api/v1/login"})
"""Asked by monitors and by whoever is not let in yet; no sign of life of an operator."""


def printable(text: str) -> str:
    if not text.isprintable():
        raise ValueError("has characters that cannot be shown; leave out line ends and control characters")
    return text.strip()


Name = Annotated[str, Field(max_length=NAME_LENGTH), AfterValidator(printable)]
Note = Annotated[str, Field(max_length=NOTE_LENGTH), AfterValidator(printable)]


class OperatorBody(Edge):
    """Without an answer: take the rig where it is free, else ask its operator for it."""

    name: Name = Field(default="", title="Name", description="By which the others know you.")
    note: Note = Field(default="", title="Note", description="What you are about.")
    answer: Literal["grant", "refuse"] | None = Field(
        default=None, title="Answer", description="The operator's, to whoever asks."
    )


async def the_lease(connection: HTTPConnection) -> LeaseDesk:
    return connection.app.state.lease


TheLease = Annotated[LeaseDesk, Depends(the_lease)]


async def the_hand(lease: TheLease, caller: TheCaller) -> Hand:
    """For a route that changes what the rig does: 409 while somebody else operates it; a free rig is taken."""
    return lease.hand(caller)


TheHand = Annotated[Hand, Depends(the_hand)]


async def listen(connection: HTTPConnection, lease: TheLease, caller: TheCaller) -> None:
    """Every request of a script is a sign of life."""
    if connection.scope["type"] == "http" and connection.url.path not in OPEN and is_heard(caller):
        lease.hear(caller)


@router.get("")
async def who(lease: TheLease, caller: TheCaller) -> dict[str, Any]:
    """Who operates, who asks, and who you are. `silent_s`: since the operator was last heard; after `lease_s` an
    attended run is held, and anybody may take over."""
    return lease.to(caller)


@router.post("", responses={ACCEPTED: {"description": "Asked for; the operator has not answered yet"}})
async def ask(
    lease: TheLease, caller: TheCaller, response: Response, body: OperatorBody | None = None
) -> dict[str, Any]:
    """Take the rig: at once where it is free or its operator silent, else after `take_over_after_s` without an
    answer, by asking again. 202 while you wait."""
    body = body or OperatorBody()
    if body.answer is not None:
        lease.answer(caller, grant=body.answer == "grant")
    elif not lease.ask(caller, body.name, body.note).holds:
        response.status_code = ACCEPTED
    return lease.to(caller)


@router.delete("")
async def release(lease: TheLease, caller: TheCaller) -> dict[str, Any]:
    """Give the rig up, or ask for it no more. An attended run is held; an unattended one goes on."""
    lease.release(caller)
    return lease.to(caller)
