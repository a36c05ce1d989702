"""What an axis is, for people: its title and unit, out of the parameter models."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from control.gait_settings import GaitSettings
from control.studies.definition import StudyDefinition
from control.studies.sections import SetupSection
from control.studies.settings import REGISTRIES
from control.studies.table import METRICS


@dataclass(frozen=True, slots=True)
class Quantity:
    """unit: as it is written; empty for names and switches."""

    title: str
    unit: str

    @property
    def label(self) -> str:
        return f"{self.title} ({self.unit})" if self.unit not in ("", "1") else self.title


def quantity(definition: StudyDefinition, name: str) -> Quantity:
    """Of an axis or of a metric; what is not known is called by its own name."""
    if name in METRICS:
        return Quantity(*METRICS[name])
    subject, _, field = name.partition(".")
    if not field:
        return Quantity(subject.capitalize(), "")
    for model in _models(definition, subject):
        described = model.get(field)
        if described is not None:
            return Quantity(described.get("title", field), described.get("unit", ""))
    return Quantity(name, "")


def _models(definition: StudyDefinition, subject: str) -> list[Mapping[str, Any]]:
    """The fields of everything that this subject may be in the study."""
    if subject == "gait":
        return [GaitSettings.model_json_schema()["properties"]]
    if subject == "setup":
        return [SetupSection.model_json_schema()["properties"]]
    if subject not in REGISTRIES:
        return []
    registry = REGISTRIES[subject]
    return [
        registry[name].Parameters.model_json_schema().get("properties", {})
        for name in _named(definition, subject)
        if name in registry
    ]


def _named(definition: StudyDefinition, subject: str) -> list[str]:
    """The section's own choice first, then those of an axis or of the listed sets."""
    section = {"controller": definition.controller, "trajectory": definition.trajectory}
    names: list[Any] = [section.get(subject, definition.plant).name]
    for axis in definition.axes:
        if axis.of == subject:
            names += axis.choices or ()
    names += [one[subject] for one in definition.sets if subject in one]
    return [name for name in dict.fromkeys(names) if isinstance(name, str)]
