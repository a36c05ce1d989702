"""Whether ME is smallest where the paper says: by the interval of the place, and by how much dearer that place is."""

from __future__ import annotations

import math

from scipy import special

from control.studies.analysis.intervals import LEVEL, Interval, mean_of_means
from control.studies.analysis.optimum import Kind, Optimum
from server.reports.experiments.measured import Measured
from server.reports.experiments.truth import Truth

NEAR = 2.5
"""How exactly the paper can tell an angle, deg: half of a step of its studies."""
RESOLVED = f"the whole interval within {NEAR:g}°, half a step of the paper's study"
NORMAL = 1.96
"""Half of an interval in standard errors, for many runs."""


def near(measured: Measured, name: str, angle: float, **fixed: object) -> Truth:
    """Whether the minimum along an axis lies at an angle, deg, as exactly as the paper can tell."""
    return between(measured, name, (angle, angle), **fixed)


def between(measured: Measured, name: str, wanted: tuple[float, float], **fixed: object) -> Truth:
    """Yes where the interval of the place lies wholly in `wanted` (deg). No where it lies wholly outside, and the best
    level is clearly below the best one in `wanted`: an interval alone would find a place in mere scatter too."""
    low, high = wanted[0] - NEAR, wanted[1] + NEAR
    where = place_of(measured.best(name, **fixed))
    if where is None or not where.known:
        return Truth.OPEN
    if where.low > high or where.high < low:
        return Truth.NO if _is_dearer(measured, name, (low, high), fixed) else Truth.OPEN
    return Truth.YES if low <= where.low and where.high <= high else Truth.OPEN


def place_of(best: Optimum | None) -> Interval | None:
    """Where a minimum was found; None where the data do not tell."""
    return None if best is None or best.kind in (Kind.FLAT, Kind.UNKNOWN) else best.where


def _is_dearer(measured: Measured, name: str, wanted: tuple[float, float], fixed: dict[str, object]) -> bool:
    """Corrected for the best level having been chosen among all (Bonferroni). What was not measured is not dearer."""
    part = measured.only(**fixed)
    means = {level: mean_of_means(part.only(**{name: level}).samples.groups()) for level in part.levels(name)}
    known = {level: mean for level, mean in means.items() if mean.known}
    inside = [mean for level, mean in known.items() if wanted[0] <= level <= wanted[1]]
    if not inside:
        return False
    there, best = (min(some, key=lambda mean: mean.value) for some in (inside, known.values()))
    error = math.hypot(there.half_width, best.half_width) / NORMAL
    if not error > 0.0:
        return there.value > best.value
    chance = 2.0 * float(special.ndtr((best.value - there.value) / error))
    return chance * max(len(known) - 1, 1) < 1.0 - LEVEL
