"""Faults on demand, for a simulated rig: what there is, what is in, put in, take away."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

from fastapi import APIRouter, Depends
from pydantic import Field, JsonValue, ValidationError

from control.simulation.faults.injection import ALWAYS, KINDS, Faults, Injection, Pattern
from control.simulation.faults.kind import FaultKind
from control.simulation.faults.promises import PROMISES, Promise
from server.api import problems, ticks
from server.api.access import TheFaultWatch, TheRig
from server.api.body import StrictRoute
from server.api.operator import TheHand
from server.api.schemas import Edge, Name
from server.fault_watch import FaultWatch, Reaction, cause_of, decay_of

if TYPE_CHECKING:
    from server.rig import Rig

router = APIRouter(prefix="/simulation/faults", tags=["simulation"], route_class=StrictRoute)

LONGEST = 86_400.0
"""A day, s: whoever wants a fault for longer leaves the duration out."""

Seconds = Annotated[float, Field(ge=0.01, le=LONGEST, json_schema_extra={"unit": "s"})]


class PatternBody(Edge):
    """A fault that comes and goes."""

    on_s: Seconds
    off_s: Seconds


class FaultBody(Edge):
    """A fault to put in; parameters that are left out keep their defaults."""

    name: Name
    parameters: dict[str, JsonValue] = Field(default_factory=dict)
    duration_s: Seconds | None = Field(
        default=None, title="Duration", description="Left out: until it is taken away."
    )
    intermittent: PatternBody | None = Field(default=None, title="Comes and goes")


async def the_faults(rig: TheRig) -> Faults:
    if rig.faults is None:
        raise problems.not_found("This rig is real; faults can be injected into a simulated one only.")
    return rig.faults


TheFaults = Annotated[Faults, Depends(the_faults)]


@dataclass(frozen=True, slots=True)
class Exhibit:
    """All that is told of the faults of one rig."""

    rig: Rig
    faults: Faults
    watch: FaultWatch

    def catalogue(self) -> dict[str, Any]:
        return {"faults": [self.entry(name) for name in KINDS]}

    def entry(self, name: str) -> dict[str, Any]:
        reaction = self.watch.of(name)
        return {
            **entry(KINDS[name], self.faults.get(name)),
            "promise": promised(PROMISES[name], decay_of(self.rig.settings)),
            "reaction": None if reaction is None else reacted(reaction, self.rig),
        }


async def the_exhibit(rig: TheRig, faults: TheFaults, watch: TheFaultWatch) -> Exhibit:
    return Exhibit(rig, faults, watch)


TheExhibit = Annotated[Exhibit, Depends(the_exhibit)]


@router.get("")
async def list_faults(exhibit: TheExhibit) -> dict[str, Any]:
    """All kinds, each with the JSON schema of its parameters, what is injected of it now, what the rig promises for it
    and what it did about the last one of its kind; null for what there is not."""
    return exhibit.catalogue()


@router.post("", status_code=201)
async def inject(body: FaultBody, exhibit: TheExhibit, hand: TheHand) -> dict[str, Any]:
    """Put a fault in, in place of one of the same name."""
    check(body)
    await exhibit.rig.between_ticks(lambda: put_in(body, exhibit), hand.require)
    return exhibit.entry(body.name)


def put_in(body: FaultBody, exhibit: Exhibit) -> None:
    """On the rig's thread: what the rig does is looked at from just before the fault."""
    duration = math.inf if body.duration_s is None else body.duration_s
    comes = body.intermittent
    pattern = ALWAYS if comes is None else Pattern(comes.on_s, comes.off_s)
    if body.name in KINDS:
        exhibit.watch.begin(body.name, is_usual=is_usual(body))
    exhibit.faults.inject(body.name, body.parameters, duration, pattern)


def is_usual(body: FaultBody) -> bool:
    """Whether the rig's promise is for this: for good, with the parameters that the promise names."""
    kind = KINDS[body.name]
    usual = kind.parameters.model_validate(dict(PROMISES[body.name].parameters))
    lasts = body.duration_s is None and body.intermittent is None
    return lasts and kind.parameters.model_validate(body.parameters) == usual


@router.delete("/{name}")
async def clear(name: str, exhibit: TheExhibit, hand: TheHand) -> dict[str, Any]:
    """Take a fault away; it is gone at the next tick. Nothing to do when it is not in."""
    if name not in KINDS:
        raise problems.not_found(
            f"There is no fault called {name[:80]!r}; GET this list to see what there is."
        )
    hand.require()
    exhibit.faults.clear(name)
    return exhibit.entry(name)


@router.delete("")
async def clear_all(exhibit: TheExhibit, hand: TheHand) -> dict[str, Any]:
    """Take all faults away."""
    hand.require()
    exhibit.faults.clear_all()
    return exhibit.catalogue()


def check(body: FaultBody) -> None:
    """Raise `Rejected` with the field for a body that cannot be carried out; `UnknownName` for the name."""
    kind = KINDS.get(body.name)
    if kind is None:
        return
    if kind.happens_once and (body.duration_s is not None or body.intermittent is not None):
        raise problems.Rejected(
            problems.invalid_field(
                ("duration_s",), f"{kind.title} happens once; leave out duration_s and intermittent"
            )
        )
    try:
        kind.parameters.model_validate(body.parameters)
    except ValidationError as error:
        raise problems.Rejected(
            problems.invalid(problems.offences(error.errors(), ("parameters",)))
        ) from error


def entry(kind: FaultKind, injection: Injection | None) -> dict[str, Any]:
    return {
        "name": kind.name,
        "row": kind.row,
        "family": kind.family.value,
        "title": kind.title,
        "what": kind.what,
        "mends": kind.mends,
        "happens_once": kind.happens_once,
        "parameters": kind.parameters.model_json_schema(),
        "injected": None if injection is None or injection.is_cleared else state(injection),
    }


def state(injection: Injection) -> dict[str, Any]:
    return {
        "parameters": injection.parameters.model_dump(mode="json"),
        "since_s": ticks.number(injection.since),
        "until_s": ticks.number(injection.until) if math.isfinite(injection.until) else None,
        "is_on": injection.is_on,
    }


def promised(promise: Promise, decay: float) -> dict[str, Any]:
    """Of a rig that walks. decay: of the coils' current, s.  noticed_ms, gone_ms: null where the robot walks on."""
    zero = promise.zero
    return {
        "sees": promise.sees,
        "states": [state.value for state in promise.states],
        "noticed_ms": promise.noticed,
        "gone_ms": None if zero is None else ticks.number(zero + decay * 1e3, 0),
        "go_on": promise.go_on,
        "parameters": dict(promise.parameters),
    }


def reacted(reaction: Reaction, rig: Rig) -> dict[str, Any]:
    """noticed_ms: until the line of the log came that says what is wrong.  gone_ms: until no current flowed."""
    cause = None if reaction.became is None else cause_of(reaction, (event.line for event in rig.events))
    return {
        "since_s": ticks.number(reaction.since),
        "was": reaction.was.value,
        "became": None if reaction.became is None else reaction.became.value,
        "reason": reaction.reason if cause is None else cause.message,
        "noticed_ms": ticks.scaled(reaction.noticed(cause), 1e3, 0),
        "gone_ms": ticks.scaled(reaction.zero, 1e3, 0),
        "verdict": reaction.judge(cause, rig.snapshot.time).value,
    }
