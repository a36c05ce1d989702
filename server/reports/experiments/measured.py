"""The tables of the studies, asked by tilt, sweep, path step and controller."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from control.studies.analysis.intervals import Interval, mean_interval
from control.studies.analysis.optimum import Optimum, optimum
from control.studies.analysis.samples import ME, Samples, samples
from control.studies.table import StudyTable
from server.reports.study.layout import STEP, SWEEP, TILT
from server.reports.study.naming import with_interval

Array = NDArray[np.float64]
STEPS = (0.1, 0.2, 0.3)
"""The paper's path steps, s."""


@dataclass(frozen=True, slots=True)
class Measured:
    """One metric of one study's runs."""

    samples: Samples

    @classmethod
    def of(cls, table: StudyTable, metric: str = ME) -> Measured:
        return cls(samples(table.rows, table.axes, metric))

    def at(self, **wanted: object) -> Array:
        """The finished runs at these values: sweep, tilt, step, controller, plant."""
        part = self.samples.only({NAMES[name]: value for name, value in wanted.items()})
        groups = part.groups()
        return np.concatenate(groups) if groups else np.array([])

    def only(self, **wanted: object) -> Measured:
        return Measured(self.samples.only({NAMES[name]: value for name, value in wanted.items()}))

    def mean(self, **wanted: object) -> Interval:
        return mean_interval(self.at(**wanted))

    def levels(self, name: str) -> list[float]:
        return self.samples.levels(NAMES[name])

    def best(self, name: str, **fixed: object) -> Optimum | None:
        """Where along one axis it is smallest; the axes that are not fixed are averaged over."""
        return optimum(self.samples, NAMES[name], {NAMES[key]: value for key, value in fixed.items()})


NAMES = {"sweep": SWEEP, "tilt": TILT, "step": STEP, "controller": "controller", "plant": "plant"}


def shown(values: Array) -> str:
    """Mean with its interval."""
    return with_interval(mean_interval(values))


def at_steps(texts: dict[float, str]) -> str:
    return "; ".join(f"Δt {step} s: {text}" for step, text in texts.items())
