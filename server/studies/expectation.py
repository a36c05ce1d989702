"""How long a study will take, before it is started: an estimate that the first runs put right."""

from __future__ import annotations

from statistics import fmean

from control.studies.checking import Survey
from control.studies.crews import cores
from control.studies.definition import StudyDefinition

COMPILED = {"geometric": 2.1e-5, "gradient": 4.3e-5}
"""Time of one processor for a second of rig time, s, by controller: compiled walks. Measured, as the next three,
by `make bench` (studies, rigid): one pass of the eight, 126 s, takes 2.6 and 5.4 ms."""
PLAIN = 2.8e-3
"""The same in plain Python, which the time law `wait`, an approach and all other controllers take: 0.35 s, by the
geometric one."""
PLANNER = 1.1e-2
"""The same for the planner: 1.4 s."""
RIGID = 0.05
"""The same for the rigid plant, whichever the controller: 20 times as fast as the rig."""
READY = 4.0
"""Until all workers have loaded the program, s. The first batch of all takes about 8 s more, which no estimate has:
its laws are compiled, and kept on the disk."""
HEADLESS = 0.15
"""Time of a simulated rig with pixels and bytes for a second of its own, s: a guess, as the next one."""
WAY_BACK = 10.0
"""Rig time of the way back to the start, s."""


def expected_wall(
    definition: StudyDefinition, survey: Survey, jobs: int = 0, *, headless: bool = False
) -> float:
    """Seconds of the wall clock. jobs: processes of a batch, 0 for one a core.  headless: the rig is simulated, as
    fast as it goes."""
    if definition.on == "rig":
        rig_time = survey.walking + survey.resting + survey.runs * WAY_BACK
        return rig_time * (HEADLESS if headless else 1.0)
    return READY + computing(definition, survey) / (jobs or cores())


def computing(definition: StudyDefinition, survey: Survey) -> float:
    """What a batch takes one processor, s."""
    return survey.walking * fmean(_costs(definition))


def _costs(definition: StudyDefinition) -> list[float]:
    """Of each combination of a controller, a plant and a way of the reference to move that the study has."""
    gait = definition.gait
    return [
        _cost(controller, plant, is_compiled=time_law != "wait" and approach != "True")
        for controller in _choices(definition, "controller", definition.controller.name)
        for plant in _choices(definition, "plant", definition.plant.name)
        for time_law in _choices(definition, "gait.time_law", gait.time_law)
        for approach in _choices(definition, "gait.approach", str(gait.approach))
    ]


def _cost(controller: str, plant: str, *, is_compiled: bool) -> float:
    if plant == "rigid":
        return RIGID
    if controller == "planner":
        return PLANNER
    return COMPILED.get(controller, PLAIN) if is_compiled else PLAIN


def _choices(definition: StudyDefinition, axis: str, own: str) -> list[str]:
    """What the axis takes, or the definition's own."""
    listed = [str(one.get(axis, own)) for one in definition.sets]
    varied = [str(value) for each in definition.axes if each.of == axis for value in each.choices or ()]
    return list(dict.fromkeys(listed or varied)) or [own]
