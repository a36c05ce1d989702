"""What a motion of the field may ask of the coils: the host's one limiter, pure.

The field B = |B| [-cos e sin h, cos e cos h, sin e] with heading h and elevation e needs the currents
I = A B, A the allocation (`control.coils`). Currents, power and the speed at which currents change all grow
with |B|, so less field keeps every direction; a current that changes too fast because the field turns is
slowed down by turning slower. The motion of the robot over the coil map changes a current by less than
1 A/s and is not counted.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from control.axes import AXES
from control.coils import Matrix, currents_for
from control.snapshot import Vector

ROUNDING = 1e-9
"""A limited value is smaller than its limit by this share, so that no rounding lifts it above."""

CURRENT, POWER, SLEW = "current", "power", "current slew"


@dataclass(frozen=True, slots=True)
class CoilLimits:
    """What the coils, their bridges and their supply bear, and how the board moves the field.

    currents: A, per coil.  power: of all coils together, sum of R I^2, W.  slew: of the current, A/s, per coil.
    resistances: ohm.  ramp: how long a change of pivot takes, s.  field_slew: of the field's strength, T/s.
    """

    currents: Vector
    power: float
    slew: Vector
    resistances: Vector
    ramp: float
    field_slew: float

    def __post_init__(self) -> None:
        for name, values in (
            ("currents", self.currents),
            ("power", (self.power,)),
            ("slew", self.slew),
            ("resistances", self.resistances),
            ("ramp", (self.ramp,)),
            ("field_slew", (self.field_slew,)),
        ):
            for value in values:
                if not 0.0 < value < math.inf:
                    raise ValueError(
                        f"coil limits: {name} must be finite and above 0 in SI units, got {value!r}"
                    )


@dataclass(frozen=True, slots=True)
class Wanted:
    """A motion of the field until the next tick.

    heading: now, rad.  rate: rad/s.  elevation: now, rad.  target: where the elevation goes, rad.
    field: strength, T.
    """

    heading: float
    rate: float
    elevation: float
    target: float
    field: float


@dataclass(frozen=True, slots=True)
class Granted:
    """What of it may be asked for. field: T.  rate: rad/s.  limited_by: what held it back, "" for nothing."""

    field: float
    rate: float
    limited_by: str


def limit(wanted: Wanted, allocation: Matrix, limits: CoilLimits, tick: float) -> Granted:
    """Less field and a slower turn where the coils would bear no more; tick: s until the next command.

    Raises ValueError where a number is not finite: there is no direction to keep, so nothing may flow.
    """
    _require_finite(wanted, allocation, tick)
    sampled = [currents_for(allocation, field) for field in _fields(wanted, tick)]
    share, limited_by = min(
        (
            _current_share(sampled, limits),
            _power_share(sampled, limits),
            _ramp_share(wanted, allocation, limits),
        ),
        key=lambda candidate: candidate[0],
    )
    field = wanted.field * share
    rate, turned_by = _rate(wanted, field, allocation, limits)
    return Granted(field, rate, limited_by or turned_by)


def check_field_slew(allocation: Matrix, limits: CoilLimits) -> None:
    """Refuse a field that comes up faster at arming than the currents may change; raises ValueError."""
    for axis, row, allowed in zip(AXES, allocation, limits.slew, strict=True):
        change = limits.field_slew * math.hypot(*row)
        if not change < allowed:
            raise ValueError(
                f"the field comes up with {limits.field_slew * 1e3:g} mT/s, which changes the current of coil "
                f"{axis} by {change:.0f} A/s; below {allowed:g} A/s is allowed: raise link.field_ramp_ms"
            )


def _require_finite(wanted: Wanted, allocation: Matrix, tick: float) -> None:
    numbers = (wanted.heading, wanted.rate, wanted.elevation, wanted.target, wanted.field, tick)
    for number in (*numbers, *(entry for row in allocation for entry in row)):
        if not math.isfinite(number):
            raise ValueError(f"the field's motion must be finite numbers, got {number} in {wanted}; refused")


def _fields(wanted: Wanted, tick: float) -> list[Vector]:
    """The fields (T) at the corners of the motion: both ends of the turn, each elevation on the way."""
    ahead = wanted.heading + wanted.rate * tick
    elevations = {wanted.elevation, wanted.target}
    if wanted.elevation * wanted.target < 0.0:
        elevations.add(0.0)
    return [
        _field(heading, elevation, wanted.field)
        for heading in (wanted.heading, ahead)
        for elevation in elevations
    ]


def _field(heading: float, elevation: float, strength: float) -> Vector:
    level = strength * math.cos(elevation)
    return -level * math.sin(heading), level * math.cos(heading), strength * math.sin(elevation)


def _share(allowed: float, needed: float) -> float:
    """The part of what is needed that is allowed; all of it where that is within the limit."""
    if needed <= allowed:
        return 1.0
    return allowed / needed * (1.0 - ROUNDING)


def _least(shares: Iterable[tuple[float, str]]) -> tuple[float, str]:
    """The smallest share and what it is named after, "" where nothing is held back."""
    share, name = min(shares, key=lambda candidate: candidate[0])
    return (share, name) if share < 1.0 else (1.0, "")


def _current_share(sampled: list[Vector], limits: CoilLimits) -> tuple[float, str]:
    return _least(
        (_share(allowed, abs(current)), f"{CURRENT} of coil {axis}")
        for currents in sampled
        for axis, current, allowed in zip(AXES, currents, limits.currents, strict=True)
    )


def _power_share(sampled: list[Vector], limits: CoilLimits) -> tuple[float, str]:
    """Power goes with the square of the field."""
    return _least((math.sqrt(_share(limits.power, _power(currents, limits))), POWER) for currents in sampled)


def _power(currents: Vector, limits: CoilLimits) -> float:
    return sum(
        resistance * current * current
        for resistance, current in zip(limits.resistances, currents, strict=True)
    )


def _spare(axis_row: Vector, allowed: float, limits: CoilLimits) -> float:
    """What the strength's own slew leaves of a coil's limit, A/s."""
    return max(0.0, allowed - limits.field_slew * math.hypot(*axis_row))


def _ramp_share(wanted: Wanted, allocation: Matrix, limits: CoilLimits) -> tuple[float, str]:
    """A change of pivot may begin at any tick and turns the elevation at 2 |e| / ramp.

    dB/de = |B| [sin e sin h, -sin e cos h, cos e]; the heading may be any.
    """
    steepest = max(abs(wanted.elevation), abs(wanted.target))
    speed = abs(wanted.field) * 2.0 * steepest / limits.ramp
    return _least(
        (
            _share(_spare(row, allowed, limits), speed * _most_by_elevation(row, steepest)),
            f"{SLEW} of coil {axis}",
        )
        for axis, row, allowed in zip(AXES, allocation, limits.slew, strict=True)
    )


def _most_by_elevation(row: Vector, steepest: float) -> float:
    """The largest p sin |e| + q cos e for |e| <= steepest, with the row's parts p in the plate and q across it.

    It rises up to tan e = p / q, where it is the length of the row.
    """
    in_plate, across = math.hypot(row[0], row[1]), abs(row[2])
    worst = min(steepest, math.atan2(in_plate, across))
    return in_plate * math.sin(worst) + across * math.cos(worst)


def _rate(wanted: Wanted, field: float, allocation: Matrix, limits: CoilLimits) -> tuple[float, str]:
    """The rate (rad/s) at which no current changes too fast: |dI/dt| <= |B| |rate| |row in the plate|."""
    share, limited_by = _least(
        (
            _share(_spare(row, allowed, limits), abs(field * wanted.rate) * math.hypot(row[0], row[1])),
            f"{SLEW} of coil {axis}",
        )
        for axis, row, allowed in zip(AXES, allocation, limits.slew, strict=True)
    )
    return wanted.rate * share, limited_by
