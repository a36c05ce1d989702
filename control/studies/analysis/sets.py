"""Every set's mean with its interval, its scatter, and which set is best."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from control.studies.analysis.intervals import NAN, Interval, mean_interval
from control.studies.analysis.samples import Samples


@dataclass(frozen=True, slots=True)
class SetSummary:
    """number: of the set in the plan.  values: of the axes, lab units.  runs: finished ones, of which the mean is.
    failed: not in the mean.  deviation: of single runs; NaN for fewer than two.
    """

    number: int
    values: Mapping[str, Any]
    runs: int
    failed: int
    mean: Interval
    deviation: float

    @property
    def variance(self) -> float:
        return self.deviation**2


def summarise(samples: Samples) -> tuple[SetSummary, ...]:
    """In the order of the plan's sets."""
    return tuple(_summary(samples, place) for place in range(len(samples.points)))


def _summary(samples: Samples, place: int) -> SetSummary:
    values = samples.of_set(place)
    return SetSummary(
        number=samples.sets[place],
        values=dict(zip(samples.axes, samples.points[place], strict=True)),
        runs=len(values),
        failed=int(np.sum(samples.place == place)) - len(values),
        mean=mean_interval(values),
        deviation=float(np.std(values, ddof=1)) if len(values) > 1 else NAN,
    )


def best(summaries: Sequence[SetSummary]) -> SetSummary | None:
    """The smallest mean; None where no run has finished."""
    measured = [one for one in summaries if math.isfinite(one.mean.value)]
    return min(measured, key=lambda one: one.mean.value, default=None)


def as_good_as_best(summaries: Sequence[SetSummary]) -> tuple[SetSummary, ...]:
    """The sets whose interval reaches down to the upper end of the best set's: the data do not part them."""
    first = best(summaries)
    if first is None or not first.mean.known:
        return ()
    return tuple(one for one in summaries if one.mean.known and one.mean.low <= first.mean.high)
