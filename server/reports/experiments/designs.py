"""The studies that section 6 asks for, from the definitions that everybody can run."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.util import find_spec

from control.studies.definition import StudyDefinition
from control.studies.examples import examples

PARAMETRIC, DISTRIBUTIONS, TILTS, RIGID = "parametric", "distributions", "tilts", "rigid"

RIGID_RUNS = 3
RIGID_DURATION_S = 40.0
"""The rigid plant is some hundred times slower than the others: a third of an eight, three runs a set."""
MISSING = "the rigid plant is not in this report: the extra `physics` (MuJoCo) is not installed"


@dataclass(frozen=True, slots=True)
class Experiment:
    """One study. key: its name in files.  repeats: of the paper, or ours where it has none."""

    key: str
    definition: StudyDefinition
    repeats: int

    @property
    def reduced(self) -> bool:
        """Fewer runs than there should be."""
        return self.definition.repeats < self.repeats

    @property
    def scale(self) -> str:
        """How much was run, in words."""
        total = self.definition.plan().total
        asked = f" instead of {self.repeats}" if self.reduced else ""
        return f"{self.definition.name}: {total} runs, {self.definition.repeats}{asked} of each set"


def experiments(runs: int | None = None) -> tuple[Experiment, ...]:
    """runs: of each set, at most; None for all of them. The rigid plant takes part where its extra is installed."""
    written = examples()
    tilts = StudyDefinition.from_toml(written["tilt-by-plant"])
    wanted = {
        PARAMETRIC: StudyDefinition.from_toml(written["paper-section-6"]),
        DISTRIBUTIONS: StudyDefinition.from_toml(written["distributions"]),
        TILTS: tilts,
    }
    if find_spec("mujoco") is not None:
        wanted[RIGID] = rigid(tilts)
    return tuple(_experiment(key, definition, runs) for key, definition in wanted.items())


def rigid(tilts: StudyDefinition) -> StudyDefinition:
    """The study of the tilts on the rigid plant, at the paper's smallest path step, a part of the eight."""
    raw = tilts.to_json()
    axes = [axis for axis in raw["axes"] if axis["of"] not in ("plant", "gait.path_step_s")]
    return StudyDefinition.from_json(
        {
            **raw,
            "name": "Tilt from 10 to 35 degrees, on the rigid plant",
            "axes": axes,
            "plant": {"name": "rigid"},
            "duration_s": RIGID_DURATION_S,
            "repeats": RIGID_RUNS,
        }
    )


def _experiment(key: str, definition: StudyDefinition, runs: int | None) -> Experiment:
    repeats = definition.repeats if runs is None else min(runs, definition.repeats)
    raw = {**definition.to_json(), "repeats": repeats}
    return Experiment(key, StudyDefinition.from_json(raw), definition.repeats)
