"""Small studies for the tests: some hundredths of a second a run."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from control.studies.definition import StudyDefinition
from server.catalogue.catalogue import Catalogue
from server.studies.carrying_out import Carried, Workforce, carry_out_batch
from server.studies.progress import Watch
from server.studies.store import StudyStore
from server.studies.study import Study

TILTS = [20, 25, 30]


CLUELESS = """
from control.controllers import controllers
from control.registry import Parameters


@controllers.register
class Clueless:
    name = "clueless"
    title = "Clueless"
    summary = "Knows nothing."

    class Parameters(Parameters):
        pass

    def __init__(self, parameters):
        pass

    def step(self, situation):
        raise ValueError("no idea")
"""
"""A plug-in whose controller fails at once."""


def definition(repeats: int = 4, **changes: Any) -> StudyDefinition:
    """Three tilts on the slip plant; by a controller whose walks are plain Python: nothing has to be compiled."""
    whole: dict[str, Any] = {
        "name": "three tilts",
        "repeats": repeats,
        "duration_s": 0.5,
        "controller": {"name": "straight"},
        "axes": [{"of": "gait.tilt_deg", "values": TILTS}],
    }
    return StudyDefinition.from_json({**whole, **changes})


@contextmanager
def opened(data: Path) -> Iterator[StudyStore]:
    catalogue = Catalogue.open(data)
    try:
        yield StudyStore(data, catalogue)
    finally:
        catalogue.close()


def carried_out(study: Study, jobs: int = 1, watch: Watch = lambda _: None) -> Carried:
    return carry_out_batch(study, Workforce(jobs), watch)


def table_of(data: Path, wanted: StudyDefinition, jobs: int = 1, dask: str | None = None) -> bytes:
    """That of a new study, carried out without interruption."""
    study = StudyStore(data).create(wanted)
    assert carry_out_batch(study, Workforce(jobs, dask)) == Carried("finished")
    return study.table().csv()
