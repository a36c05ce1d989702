"""The electrical half of a simulated board: three H-bridges, the coils behind them, and what the board senses.

A bridge that is off shorts its coil, so the current decays with the coil's own L/R.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from control.link.messages import Triple
from control.simulation.coil_drive import PWM_STEPS
from control.simulation.conditions import checked
from control.simulation.regulator import FULL_COUNT
from control.snapshot import ZERO, Vector

COUNTS_PER_AMPERE = 0.14 / 5.0 * 1024.0
"""The VNH5019's current sense, 0.14 V/A, in 10 bits of 5 V (datasheet)."""

SUPPLY_FULL_SCALE = 55.0
"""The supply that fills the ADC, V: a divider of 100 k over 10 k before 5 V."""

MOST_SUPPLY = 65.0
_TICK = 1e-3


@dataclass(frozen=True, slots=True)
class Winding:
    """One coil pair as its bridge sees it: ohm, H."""

    resistance: float
    inductance: float

    def __post_init__(self) -> None:
        for name in ("resistance", "inductance"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise ValueError(f"a coil's {name} is {value!r}; it must be a positive number in SI units")


@dataclass(frozen=True, slots=True)
class Circuit:
    """One coil with its bridge, its leads and its current sense.

    sense: what the sense shows for one ampere, 1 when it is true.
    """

    winding: Winding
    steps: int
    sense: float = 1.0
    is_open: bool = False
    is_swapped: bool = False
    has_fault: bool = False

    @property
    def decay(self) -> float:
        """The share of the current that is left after one millisecond without drive."""
        if self.is_open:
            return 0.0
        return math.exp(-_TICK * self.winding.resistance / self.winding.inductance)

    @property
    def gain(self) -> float:
        """Ampere that one PWM step and one volt of supply add in one millisecond."""
        if self.is_open or self.has_fault:
            return 0.0
        sign = -1.0 if self.is_swapped else 1.0
        return sign * (1.0 - self.decay) / self.winding.resistance / self.steps

    def with_condition(self, name: str, value: int) -> Circuit:
        match name:
            case "driver_fault":
                return replace(self, has_fault=bool(value))
            case "sense_permille":
                return replace(self, sense=value * 1e-3)
            case "open_coil":
                return replace(self, is_open=bool(value))
            case "swapped":
                return replace(self, is_swapped=bool(value))
            case _:
                return replace(self, winding=Winding(value * 1e-3, self.winding.inductance))


class Bridges:
    """Three circuits on one supply; time moves in `step`, a millisecond each.

    currents: of the coils, A, positive towards the field's positive axis.
    """

    def __init__(self, coils: tuple[Winding, Winding, Winding], supply: float) -> None:
        self.currents: Vector = ZERO
        self._circuits = tuple(Circuit(coil, steps) for coil, steps in zip(coils, PWM_STEPS, strict=True))
        self._wire()
        self.supply = supply

    def _wire(self) -> None:
        self._decay = tuple(circuit.decay for circuit in self._circuits)
        self._gain = tuple(circuit.gain for circuit in self._circuits)
        self._sense = tuple(circuit.sense * COUNTS_PER_AMPERE for circuit in self._circuits)

    def step(self, duty: Triple) -> Vector:
        """The exact solution for signed PWM steps that are held for one millisecond; the currents, A."""
        i1, i2, i3 = self.currents
        d1, d2, d3 = duty
        a1, a2, a3 = self._decay
        b1, b2, b3 = self._gain
        supply = self._supply
        self.currents = (
            a1 * i1 + b1 * d1 * supply,
            a2 * i2 + b2 * d2 * supply,
            a3 * i3 + b3 * d3 * supply,
        )
        return self.currents

    @property
    def counts(self) -> Triple:
        """What the ADC makes of the unsigned current senses."""
        i1, i2, i3 = self.currents
        s1, s2, s3 = self._sense
        return _count(abs(i1) * s1), _count(abs(i2) * s2), _count(abs(i3) * s3)

    @property
    def supply(self) -> float:
        """V; 0 is a supply that is switched off."""
        return self._supply

    @supply.setter
    def supply(self, volts: float) -> None:
        if not (math.isfinite(volts) and 0.0 <= volts <= MOST_SUPPLY):
            raise ValueError(f"supply is {volts!r} V; allowed is 0 to {MOST_SUPPLY:g} V")
        self._supply = volts
        self.supply_count = _count(volts / SUPPLY_FULL_SCALE * 1024.0)

    @property
    def has_driver_fault(self) -> bool:
        return any(circuit.has_fault for circuit in self._circuits)

    def set_condition(self, name: str, value: int, coil: int | None = None) -> None:
        """One of `control.simulation.conditions`; `ConditionRefused` when it is none."""
        if not checked(name, value, coil).per_coil:
            self.supply = value * 1e-3
            return
        self._circuits = tuple(
            circuit.with_condition(name, value) if place == coil else circuit
            for place, circuit in enumerate(self._circuits, start=1)
        )
        self._wire()


def _count(level: float) -> int:
    """The ADC's reading: rounded down, at most full scale."""
    count = int(level)
    return count if count < FULL_COUNT else FULL_COUNT
