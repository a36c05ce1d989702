"""From one set of values to what a run needs: names known, parameters complete, checked and in SI."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from pydantic import ValidationError

from control.controllers import controllers
from control.gait import Gait
from control.gait_settings import GaitSettings
from control.registry import Registry, UnknownName
from control.runs import Choice, Selection
from control.simulation.plants import PlantChoice, plants
from control.studies.errors import StudyError
from control.studies.sections import ChoiceSection, SetupSection
from control.trajectories import trajectories
from control.wrong_values import in_words

if TYPE_CHECKING:
    from control.studies.definition import StudyDefinition

MM = 1e-3
MS = 1e-3

REGISTRIES: dict[str, Registry[Any]] = {
    "controller": controllers,
    "trajectory": trajectories,
    "plant": plants,
}


@dataclass(frozen=True, slots=True)
class Setup:
    """The rig that a batch stands for. length: between the pivots, m.  workspace: half the side of the square in
    which the centre may be, m.  ramp: of the elevation at a switch, s."""

    length: float = 0.010
    workspace: float = 0.060
    ramp: float = 0.050


@dataclass(frozen=True, slots=True)
class Settings:
    """What one set of values fixes."""

    selection: Selection
    plant: PlantChoice
    setup: Setup


Values = Mapping[str, Any]


def settle(definition: StudyDefinition, values: Values) -> Settings:
    """values: axis to value, lab units. Raises `StudyError` for a set that cannot be carried out."""
    controller = choice(definition.controller, "controller", part(values, "controller"))
    trajectory = choice(definition.trajectory, "trajectory", part(values, "trajectory"))
    plant = choice(definition.plant, "plant", part(values, "plant"))
    return Settings(
        Selection(controller, trajectory, gait(definition.gait, part(values, "gait"))),
        PlantChoice(plant.name, plant.parameters),
        setup(definition.setup, part(values, "setup")),
    )


def part(values: Values, subject: str) -> dict[str, Any]:
    """The values of one subject: "" for its name, else the parameter; what is None keeps its default."""
    return {
        axis.partition(".")[2]: value
        for axis, value in values.items()
        if value is not None and axis.partition(".")[0] == subject
    }


def choice(section: ChoiceSection, kind: str, given: Values) -> Choice:
    """The section's parameters belong to the thing that it names; another one starts from its own defaults."""
    parameters = {name: value for name, value in given.items() if name}
    name = given.get("", section.name)
    if name == section.name:
        parameters = {**section.parameters, **parameters}
    try:
        model = REGISTRIES[kind][name].Parameters
        checked = model.model_validate_json(json.dumps(parameters), strict=True)
    except UnknownName as error:
        raise StudyError(str(error)) from None
    except ValidationError as error:
        raise StudyError(f"{kind} {name}:\n{in_words(error)}") from None
    return Choice(name, checked.model_dump(mode="json"))


def gait(section: GaitSettings, given: Values) -> Gait:
    try:
        return GaitSettings.model_validate({**section.model_dump(), **given}).to_si()
    except ValidationError as error:
        raise StudyError(f"gait:\n{in_words(error)}") from None


def setup(section: SetupSection, given: Values) -> Setup:
    try:
        whole = SetupSection.model_validate({**section.model_dump(), **given})
    except ValidationError as error:
        raise StudyError(f"setup:\n{in_words(error)}") from None
    return Setup(whole.length_mm * MM, 0.5 * whole.workspace_mm * MM, whole.ramp_ms * MS)
