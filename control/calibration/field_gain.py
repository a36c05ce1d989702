"""Field per ampere: what a hand-held magnetometer shows, against what the coils' geometry says.

Each reading is one component of the field at one point while one pair carries a known current. With the
geometry's field per ampere k (T/A) of that pair at that point, the reading is b = g k I + a: one gain g for
each pair, and the room's own field a (the earth's, a bench's) for each component. Least squares over all
readings; reversed currents tell g from a.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from control.axes import AXES, Axis
from control.coils import CoilPair, field_per_ampere
from control.snapshot import Vector

Floats = NDArray[np.float64]

FEWEST_READINGS = 4
"""Of each pair: two currents each way, so that a slip of the pen shows."""
WORST_RESIDUAL = 0.05
"""A pair's readings may scatter by this share of its field: 5 mm beside its place a probe in the paper's rig
reads 0.3 % wrong, a handheld Hall probe 1 to 2 %, 10 degrees askew 1.5 %."""
GAINS = (0.5, 2.0)
"""A gain beyond is no tolerance of windings but another coil than the rig file's."""
LEAST_FIELD = 0.1e-3
"""The pair's field must be this strong at one of the points at least, T: twice the earth's."""
DIFFERENT_CURRENTS = 0.2
"""Two currents of a pair must differ by this, A, to tell its field from the room's."""


class BadReadings(ValueError):
    """Readings that make no sense together; the text says which, and the likely cause."""


@dataclass(frozen=True, slots=True)
class Reading:
    """One look at the magnetometer.

    coil: the pair that carries `current` (A).  point: of the probe in the coils' frame, m.
    component: along which axis of the coils' frame the probe measures.  field: what it shows, T.
    """

    coil: Axis
    current: float
    point: Vector
    component: Axis
    field: float

    def __post_init__(self) -> None:
        if self.coil not in AXES or self.component not in AXES:
            raise BadReadings(f"a reading names a coil and a component x, y or z, got {self}")
        if not all(math.isfinite(value) for value in (self.current, self.field, *self.point)):
            raise BadReadings(f"a reading's numbers must be finite, got {self}")


@dataclass(frozen=True, slots=True)
class PairGain:
    """gain: field over the geometry's.  standard_error: of it.  residual: rms, share of the pair's field."""

    gain: float
    standard_error: float
    residual: float
    readings: int


@dataclass(frozen=True, slots=True)
class FieldCalibration:
    """pairs: by axis, only those that were measured.  ambient: the room's field, T; 0 where not measured."""

    pairs: dict[Axis, PairGain]
    ambient: Vector

    @property
    def worst_residual(self) -> float:
        return max(pair.residual for pair in self.pairs.values())


def fit_field(pairs: Sequence[CoilPair], readings: Sequence[Reading]) -> FieldCalibration:
    """The pairs' gains from their readings; raises `BadReadings`."""
    coils: list[Axis] = [axis for axis in AXES if any(reading.coil == axis for reading in readings)]
    if not coils:
        raise BadReadings("there are no readings; measure at least one pair of coils")
    geometry = _geometric_fields(pairs, readings)
    for coil in coils:
        _require_enough(coil, readings, geometry)
    components = [axis for axis in AXES if any(reading.component == axis for reading in readings)]
    columns = [_of_coil(readings, coil) * geometry for coil in coils]
    columns += [np.array([float(reading.component == axis) for reading in readings]) for axis in components]
    fit = _LeastSquares(np.column_stack(columns), np.array([reading.field for reading in readings]))
    _require_sense(dict(zip(coils, fit.solution.tolist(), strict=False)))
    found: dict[Axis, PairGain] = {
        coil: _pair_gain(number, coil, readings, geometry, fit) for number, coil in enumerate(coils)
    }
    room = dict(zip(components, fit.solution[len(coils) :].tolist(), strict=True))
    return FieldCalibration(found, (room.get("x", 0.0), room.get("y", 0.0), room.get("z", 0.0)))


class _LeastSquares:
    """The solution of design @ solution = fields, what is left over, and how sure it is."""

    def __init__(self, design: Floats, fields: Floats) -> None:
        self.solution, _, rank, _ = np.linalg.lstsq(design, fields, rcond=None)
        if rank < design.shape[1]:
            raise BadReadings(
                "the readings do not tell coils and room apart; measure each with reversed current too"
            )
        inverse = np.linalg.inv(design.T @ design)
        self.misses: Floats = fields - design @ self.solution
        freedom = max(1, design.shape[0] - design.shape[1])
        self.errors: Floats = np.sqrt(np.diag(inverse) * float(self.misses @ self.misses) / freedom)
        influence = np.einsum("ij,jk,ik->i", design, inverse, design)
        self.alone: Floats = self.misses / np.maximum(1.0 - influence, 1e-6)
        """How far each reading is off what all others say; a false one bends its own fit."""


def _geometric_fields(pairs: Sequence[CoilPair], readings: Sequence[Reading]) -> Floats:
    """(n,) T: what each reading would be without the room and with a gain of 1."""
    plain = [replace(pair, gain=1.0) for pair in pairs]
    order = [pair.axis for pair in plain]
    per_ampere = field_per_ampere(plain, np.array([reading.point for reading in readings]))
    fields = [
        per_ampere[index, AXES.index(reading.component), order.index(reading.coil)] * reading.current
        for index, reading in enumerate(readings)
    ]
    return np.array(fields)


def _of_coil(readings: Sequence[Reading], coil: Axis) -> Floats:
    return np.array([float(reading.coil == coil) for reading in readings])


def _require_enough(coil: Axis, readings: Sequence[Reading], geometry: Floats) -> None:
    own = [reading for reading in readings if reading.coil == coil]
    if len(own) < FEWEST_READINGS:
        raise BadReadings(
            f"the {coil} coils have {len(own)} readings, {FEWEST_READINGS} are needed: "
            "two currents, each of them reversed as well"
        )
    currents = [reading.current for reading in own]
    if not max(currents) - min(currents) >= DIFFERENT_CURRENTS or min(currents) * max(currents) >= 0.0:
        raise BadReadings(
            f"the {coil} coils were measured with one direction of current only; reverse it as well, "
            "so that the room's own field drops out"
        )
    if not np.abs(_of_coil(readings, coil) * geometry).max() >= LEAST_FIELD:
        raise BadReadings(
            f"the {coil} coils make less than {LEAST_FIELD * 1e3:g} mT where the probe was, in its direction; "
            f"measure the {coil} component near their centre"
        )


def _require_sense(gains: dict[Axis, float]) -> None:
    wrong = [coil for coil, gain in gains.items() if not gain > 0.0]
    if len(wrong) > 1 and len(wrong) == len(gains):
        raise BadReadings(
            "every field has the wrong sign: the probe was held the other way round, or all leads are swapped"
        )
    for coil, gain in gains.items():
        if gain < -0.1:
            raise BadReadings(
                f"the {coil} coils' field has the wrong sign ({gain:.2f} of the geometry's): their leads are "
                "swapped; exchange them at the driver, or turn the probe if it was held the other way round"
            )
        if not GAINS[0] <= gain <= GAINS[1]:
            raise BadReadings(
                f"the {coil} coils make {gain:.2f} times the field that their geometry says, allowed is "
                f"{GAINS[0]:g} to {GAINS[1]:g}: check diameter, separation and turns in the rig file, the unit "
                "of the readings (mT), and that these are the coils on this driver"
            )


def _pair_gain(
    number: int, coil: Axis, readings: Sequence[Reading], geometry: Floats, fit: _LeastSquares
) -> PairGain:
    own = _of_coil(readings, coil).astype(bool)
    gain, error = float(fit.solution[number]), float(fit.errors[number])
    field = gain * math.sqrt(float(np.mean(geometry[own] ** 2)))
    residual = math.sqrt(float(np.mean(fit.misses[own] ** 2))) / field
    if not residual <= WORST_RESIDUAL:
        worst = int(np.argmax(np.where(own, np.abs(fit.alone), -1.0)))
        reading = readings[worst]
        raise BadReadings(
            f"the readings of the {coil} coils scatter by {100 * residual:.1f} %, allowed is "
            f"{100 * WORST_RESIDUAL:g} %; the others do not agree with {reading.field * 1e3:.3f} mT at "
            f"{reading.current:g} A ({reading.component} component): it is {fit.alone[worst] * 1e3:+.3f} mT off"
        )
    return PairGain(gain, error, residual, int(own.sum()))
