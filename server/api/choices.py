"""From what a request names to what the rig can use: known names, complete and checked parameters."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any

from pydantic import ValidationError

from control.controllers import controllers
from control.gait_settings import GaitSettings
from control.registry import Registry, UnknownName
from control.runs import Choice, Selection
from control.trajectories import trajectories
from server.api.problems import Problem, Rejected, invalid, invalid_field, offences
from server.api.schemas import (
    ChoiceBody,
    ChoiceChange,
    GaitChange,
    SelectionBody,
    SelectionChange,
)

Location = tuple[str | int, ...]


def select(body: SelectionBody) -> Selection:
    """A whole selection; raises Rejected with every offending field of the first part that is wrong."""
    return Selection(
        checked(controllers, body.controller, ("controller",)),
        checked(trajectories, body.trajectory, ("trajectory",)),
        body.gait.to_si(),
    )


def change(selection: Selection, body: SelectionChange) -> Selection:
    """The selection with the given parts replaced."""
    return Selection(
        checked(controllers, merged(selection.controller, body.controller), ("controller",)),
        checked(trajectories, merged(selection.trajectory, body.trajectory), ("trajectory",)),
        changed_gait(selection, body.gait).to_si(),
    )


def merged(current: Choice, body: ChoiceChange) -> ChoiceBody:
    """Parameters that are left out stay as they are, or are the defaults of another choice."""
    name = body.name or current.name
    kept = current.parameters if name == current.name else {}
    return ChoiceBody(name=name, parameters={**kept, **body.parameters})


def changed_gait(selection: Selection, body: GaitChange) -> GaitSettings:
    current = GaitSettings.from_si(selection.gait).model_dump()
    try:
        return GaitSettings.model_validate({**current, **body.model_dump(exclude_none=True)})
    except ValidationError as error:
        raise Rejected(invalid(offences(error.errors(), ("gait",)))) from None


def checked(registry: Registry[Any], body: ChoiceBody, where: Location = ()) -> Choice:
    """A registered choice with all of its parameters; raises Rejected (422) for anything else."""
    try:
        entry = registry[body.name]
    except UnknownName as error:
        raise Rejected(invalid_field((*where, "name"), str(error), ", ".join(registry))) from None
    try:
        parameters = entry.Parameters.model_validate_json(json.dumps(body.parameters), strict=True)
    except ValidationError as error:
        raise Rejected(invalid(offences(error.errors(), (*where, "parameters")))) from None
    return Choice(body.name, parameters.model_dump(mode="json"))


def listing(registry: Registry[Any]) -> list[dict[str, Any]]:
    """What there is to choose from, with the JSON schema of each one's parameters."""
    return [
        {
            "name": entry.name,
            "title": entry.title,
            "summary": entry.summary,
            "parameters": entry.Parameters.model_json_schema(),
        }
        for entry in registry.values()
    ]


def choice_json(registry: Registry[Any], choice: Choice) -> dict[str, Any]:
    """With all parameters, also those that were left at their defaults, as far as the choice is still there."""
    if choice.name not in registry:
        return {"name": choice.name, "parameters": dict(choice.parameters)}
    complete = registry[choice.name].Parameters.model_validate(dict(choice.parameters))
    return {"name": choice.name, "parameters": complete.model_dump(mode="json")}


def selection_json(selection: Selection) -> dict[str, Any]:
    return {
        "controller": choice_json(controllers, selection.controller),
        "trajectory": choice_json(trajectories, selection.trajectory),
        "gait": GaitSettings.from_si(selection.gait).model_dump(),
    }


def taken(name: str, known: Iterable[str]) -> Problem:
    names = ", ".join(known)
    return Problem(
        409, "Name taken", f"There is a trajectory called {name!r} already; choose a name other than {names}."
    )
