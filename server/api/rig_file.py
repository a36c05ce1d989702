"""The rig file: its values, changes of them while the rig runs, and the way back."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Annotated, Any

from fastapi import APIRouter, Body, Response
from pydantic import Field

from server.access.caller import TheCaller
from server.api.access import TheChanges, TheRig
from server.api.body import StrictRoute
from server.api.operator import TheHand, TheLease
from server.api.problems import Problem, Rejected, invalid, offence
from server.api.schemas import Edge
from server.rig import Rig
from server.rig_changes import Change, DoNotGoTogether, NeedsDisarmed, RigChanges
from server.rig_file import RigFileError
from server.rig_import import UnusableText
from server.rig_schema import rig_schema

LONGEST_FILE = 200_000
"""Characters; the longest honest one, with thirty colour profiles, has some 10 000."""

router = APIRouter(prefix="/rig", tags=["rig file"], route_class=StrictRoute)

Changes = Annotated[
    dict[str, Any],
    Body(
        description="Nested values as in the rig file; null puts a default back.",
        examples=[{"limits": {"field_mT": 12.0}}],
    ),
]


@router.get("")
async def values(rig: TheRig, changes: TheChanges) -> dict[str, Any]:
    """The rig file's values, in the lab's units, and which file they come from."""
    return public(rig, changes)


@router.patch("")
async def alter(body: Changes, rig: TheRig, changes: TheChanges, hand: TheHand) -> dict[str, Any]:
    """Change values, and save them: all of them or none. Most need a disarmed rig, which is then rebuilt."""
    with told():
        return answer(rig, changes, await served(changes).patch(body, hand.require))


@router.get("/schema")
async def schema() -> dict[str, Any]:
    """The rig file as a JSON schema: titles, units, ranges, defaults, and which values need a disarmed rig."""
    return rig_schema()


@router.get("/file.toml", response_class=Response, responses={200: {"content": {"application/toml": {}}}})
async def file(changes: TheChanges) -> Response:
    """The rig file with its comments, to keep or to take to another computer; logins and keys are hidden."""
    text = served(changes).exported()
    headers = {"Content-Disposition": 'attachment; filename="rig.toml"'}
    return Response(text, media_type="application/toml; charset=utf-8", headers=headers)


class ImportBody(Edge):
    """Another rig file. What it hides with *** stays as it is here."""

    toml: Annotated[str, Field(max_length=LONGEST_FILE)]
    apply: bool = False
    """Else it is looked at, and nothing changes."""


@router.post("/import")
async def take_over(
    body: ImportBody, rig: TheRig, changes: TheChanges, lease: TheLease, caller: TheCaller
) -> dict[str, Any]:
    """Look at another rig file as a whole (`differences`), or apply it: whole, and to a disarmed rig."""
    with told(), unusable():
        if body.apply:
            hand = lease.hand(caller)
            return answer(rig, changes, await served(changes).take(body.toml, hand.require))
        return {"differences": await served(changes).look_at(body.toml)}


@router.post("/reload")
async def reload(rig: TheRig, changes: TheChanges, hand: TheHand) -> dict[str, Any]:
    """Take over what somebody has edited in the file."""
    with told():
        return answer(rig, changes, await served(changes).reload(hand.require))


@router.post("/undo")
async def undo(rig: TheRig, changes: TheChanges, hand: TheHand) -> dict[str, Any]:
    """Back to the file as it was before it changed last; once more goes forth again."""
    with told():
        return answer(rig, changes, await served(changes).undo(hand.require))


def public(rig: Rig, changes: RigChanges | None) -> dict[str, Any]:
    return {**rig.settings.to_public(), "file": None if changes is None else changes.public()}


def answer(rig: Rig, changes: RigChanges | None, change: Change) -> dict[str, Any]:
    return {**public(rig, changes), "changed": list(change.fields), "rebuilt": change.rebuilt}


def served(changes: RigChanges | None) -> RigChanges:
    if changes is None:
        raise Rejected(Problem(409, "No rig file", "This server has no rig file that could be changed."))
    return changes


def own_file(changes: RigChanges | None) -> RigChanges:
    """The file for what was measured here, unless its camera is another one."""
    file = served(changes)
    if "camera.uri" in file.public()["overridden"]:
        raise Rejected(
            Problem(
                409,
                "Another camera",
                "This server simulates the rig of its file; what is measured here does not hold for the real one. "
                "Start it without --sim to calibrate that.",
            )
        )
    return file


@contextmanager
def unusable() -> Iterator[None]:
    """A file that came with the request is the request's fault."""
    try:
        yield
    except UnusableText as error:
        raise Rejected(Problem(422, "Not acceptable", str(error))) from error


@contextmanager
def told() -> Iterator[None]:
    """What can go wrong with a change, as a problem document."""
    try:
        yield
    except NeedsDisarmed as error:
        where = [offence(field.split("."), "needs a disarmed rig") for field in error.fields]
        raise Rejected(Problem(409, "Needs a disarmed rig", str(error), tuple(where))) from error
    except DoNotGoTogether as error:
        raise Rejected(invalid([offence((), str(error))])) from error
    except RigFileError as error:
        raise Rejected(Problem(409, "Rig file", str(error))) from error
