"""How long a study will take, before it is started: an estimate that the first runs put right."""

from __future__ import annotations

from statistics import fmean

from control.studies.checking import Survey
from control.studies.crews import cores
from control.studies.definition import StudyDefinition

COMPILED = {"geometric": 3e-5, "gradient": 6e-5}
"""Time of one processor for a second of rig time, s, by controller: compiled walks. Measured, as the next three."""
PLAIN = 0.008
"""The same for walks in plain Python, which all other controllers and the time law `wait` take; the planner, too."""
RIGID = 0.07
"""The same for the rigid plant, whichever the controller."""
READY = 4.0
"""Until all workers have loaded the program, s."""
HEADLESS = 0.15
"""Time of a simulated rig with pixels and bytes for a second of its own, s."""
WAY_BACK = 10.0
"""Rig time of the way back to the start, s."""


def expected_wall(
    definition: StudyDefinition, survey: Survey, jobs: int = 0, *, simulated: bool = False
) -> float:
    """Seconds of the wall clock. jobs: processes of a batch, 0 for one a core.  simulated: the rig is."""
    if definition.on == "rig":
        rig_time = survey.walking + survey.resting + survey.runs * WAY_BACK
        return rig_time * (HEADLESS if simulated else 1.0)
    return READY + survey.walking * fmean(_costs(definition)) / (jobs or cores())


def _costs(definition: StudyDefinition) -> list[float]:
    """Of each pair of a controller and a plant that the study has."""
    return [
        _cost(controller, plant, definition.gait.time_law)
        for controller in _choices(definition, "controller", definition.controller.name)
        for plant in _choices(definition, "plant", definition.plant.name)
    ]


def _cost(controller: str, plant: str, time_law: str) -> float:
    if plant == "rigid":
        return RIGID
    return PLAIN if time_law == "wait" else COMPILED.get(controller, PLAIN)


def _choices(definition: StudyDefinition, axis: str, own: str) -> list[str]:
    """What the axis takes, or the definition's own."""
    listed = [str(one.get(axis, own)) for one in definition.sets]
    varied = [str(value) for each in definition.axes if each.of == axis for value in each.choices or ()]
    return list(dict.fromkeys(listed or varied)) or [own]
