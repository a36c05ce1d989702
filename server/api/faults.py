"""Faults on demand, for a simulated rig: what there is, what is in, put in, take away."""

from __future__ import annotations

import math
from typing import Annotated, Any

from fastapi import APIRouter, Depends
from pydantic import Field, JsonValue, ValidationError

from control.simulation.faults.injection import ALWAYS, KINDS, Faults, Injection, Pattern
from control.simulation.faults.kind import FaultKind
from server.api import problems, ticks
from server.api.access import TheRig
from server.api.body import StrictRoute
from server.api.schemas import Edge, Name

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


@router.get("")
async def list_faults(faults: TheFaults) -> dict[str, Any]:
    """All kinds, each with the JSON schema of its parameters and what is injected of it now, or null."""
    return catalogue(faults)


@router.post("", status_code=201)
async def inject(body: FaultBody, rig: TheRig, faults: TheFaults) -> dict[str, Any]:
    """Put a fault in, in place of one of the same name."""
    check(body)
    duration = math.inf if body.duration_s is None else body.duration_s
    comes = body.intermittent
    pattern = ALWAYS if comes is None else Pattern(comes.on_s, comes.off_s)
    injection = await rig.between_ticks(lambda: faults.inject(body.name, body.parameters, duration, pattern))
    return entry(injection.kind, faults.get(body.name))


@router.delete("/{name}")
async def clear(name: str, faults: TheFaults) -> dict[str, Any]:
    """Take a fault away; it is gone at the next tick. Nothing to do when it is not in."""
    if name not in KINDS:
        raise problems.not_found(
            f"There is no fault called {name[:80]!r}; GET this list to see what there is."
        )
    faults.clear(name)
    return entry(KINDS[name], faults.get(name))


@router.delete("")
async def clear_all(faults: TheFaults) -> dict[str, Any]:
    """Take all faults away."""
    faults.clear_all()
    return catalogue(faults)


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


def catalogue(faults: Faults) -> dict[str, Any]:
    return {"faults": [entry(kind, faults.get(kind.name)) for kind in KINDS.values()]}


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
