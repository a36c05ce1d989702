"""About how long a study will take, before anything of it is measured."""

from __future__ import annotations

import os

from control.studies.checking import Survey
from control.studies.definition import StudyDefinition
from control.studies.design import sets_of

WAY_BACK = 25.0
"""To the start of a run, with arming and settling, s; measured on the simulated rig with the eight."""
COMPILED = 20_000.0
"""Seconds of walking that one core simulates in a second, with a compiled law; measured on a laptop's core."""
PLAIN = 80.0
"""The same with any other law (plain Python), or a plant of slip."""
RIGID = 1.5
"""The same with the rigid plant."""
STARTING = 3.0
"""Until the workers of a batch have begun, s."""
LAWS = ("geometric", "gradient")
"""Those that are compiled for the plants without contacts."""


def wall_time(definition: StudyDefinition, survey: Survey) -> float:
    """An estimate, s; on a rig with the rests and the ways back."""
    if definition.on == "rig":
        return survey.walking + survey.resting + survey.runs * WAY_BACK
    return STARTING + survey.walking / (_pace(definition) * max(1, os.cpu_count() or 1))


def _pace(definition: StudyDefinition) -> float:
    """Seconds of walking a second of one core; the slowest of what the study asks for."""
    if "rigid" in _named(definition, "plant", definition.plant.name):
        return RIGID
    gait = definition.gait
    plain = gait.approach or gait.time_law == "wait"
    laws = _named(definition, "controller", definition.controller.name)
    return COMPILED if laws <= set(LAWS) and not plain else PLAIN


def _named(definition: StudyDefinition, subject: str, own: str) -> set[str]:
    """All names that a controller or a plant has in the study."""
    if definition.design == "list":
        return {str(values.get(subject) or own) for values in sets_of(definition)}
    for axis in definition.axes:
        if axis.of == subject:
            return {str(value) for value in axis.choices or ()}
    return {own}
