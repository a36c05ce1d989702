"""How hot the coils are, estimated from their currents (I^2 t): a first-order model per coil, pure.

A coil's share of the heat that it may have follows d(share)/dt = ((I / I_c)^2 - share) / T, with I_c the
current that it bears for ever and T its thermal time constant: 1 is the temperature that I_c leads to.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from control.coils import CoilPair
from control.snapshot import ZERO, Vector

WARN_AT = 0.8
"""Share of the heat at which a warning begins, and below which a coil that was too hot may be used again."""
OFF_AT = 1.0
"""Share of the heat at which the coils are switched off."""
ASSUMED_AT_START = 0.8
"""What a real rig's coils are taken for at a start, since nothing is known of what they carried before: as warm as
they may be for use. From there they cool by the model."""
MOST_CURRENT = 50.0
"""A current that is no number, or is beyond what the board's sense can show (44.6 A), counts as this, A."""

COPPER_RESISTIVITY = 1.68e-8
"""Of copper at 20 degrees C, ohm m."""
COPPER_HEAT = 385.0 * 8960.0
"""Heat capacity of copper, J/(m^3 K)."""
FILL = 0.6
"""Share of copper in a winding's cross-section (round wire, wound in layers; assumed)."""
COOLING = 10.0
"""Heat that still air takes from a surface, W/(m^2 K): convection and radiation (textbook, 5 to 15)."""
WARMING = 40.0
"""How much warmer than the room a winding may become, K: to 65 degrees C, which a hand can just bear."""


@dataclass(frozen=True, slots=True)
class ThermalLimits:
    """continuous: the current that each coil bears for ever, A.  time_constants: s."""

    continuous: Vector
    time_constants: Vector

    def __post_init__(self) -> None:
        for name, values in (("continuous", self.continuous), ("time_constants", self.time_constants)):
            for value in values:
                if not 0.0 < value < math.inf:
                    raise ValueError(f"coil heat: {name} must be finite and above 0, got {value!r}")


@dataclass(frozen=True, slots=True)
class CoilHeat:
    """shares: of the heat that each coil may have.  is_too_hot: one was at 100 %, and not all are below 80 % yet."""

    shares: Vector = ZERO
    is_too_hot: bool = False

    def __post_init__(self) -> None:
        for share in self.shares:
            if not 0.0 <= share < math.inf:
                raise ValueError(f"a coil's share of its heat is finite and not below 0, got {share!r}")

    def after(self, elapsed: float, currents: Vector, limits: ThermalLimits) -> CoilHeat:
        """The heat after `elapsed` (s) with these currents (A); a time that is no number is none."""
        elapsed = elapsed if elapsed > 0.0 else 0.0
        one, two, three = (
            _warmed(share, elapsed, current / continuous, constant)
            for share, current, continuous, constant in zip(
                self.shares, map(_counted, currents), limits.continuous, limits.time_constants, strict=True
            )
        )
        return CoilHeat((one, two, three), self._stays_off((one, two, three)))

    def _stays_off(self, shares: Vector) -> bool:
        hottest = max(shares)
        return hottest >= OFF_AT or (self.is_too_hot and hottest >= WARN_AT)

    def wait(self, limits: ThermalLimits) -> float:
        """How long the coils must rest until all are below 80 %, s."""
        return max(
            constant * math.log(share / WARN_AT) if share > WARN_AT else 0.0
            for share, constant in zip(self.shares, limits.time_constants, strict=True)
        )


UNKNOWN = CoilHeat((ASSUMED_AT_START, ASSUMED_AT_START, ASSUMED_AT_START))
"""The coils of a rig that has just been started."""


def _counted(current: float) -> float:
    return abs(current) if -MOST_CURRENT <= current <= MOST_CURRENT else MOST_CURRENT


def _warmed(share: float, elapsed: float, load: float, constant: float) -> float:
    """The exact solution over `elapsed` at a constant load I / I_c."""
    final = load * load
    return share - (final - share) * math.expm1(-elapsed / constant)


def winding_estimate(pair: CoilPair) -> tuple[float, float]:
    """Continuous current (A) and time constant (s) of a pair, from its size, turns and resistance.

    The wire's cross-section a follows from R = rho l / a, its copper's heat capacity C from l a; the bundle is
    taken as a square of n a / fill, whose four sides give the heat to the air: G = h A. Then T = C / G and
    R I_c^2 = G dT. An estimate for a rig file that says nothing better.
    """
    around = math.pi * pair.diameter
    length = 2.0 * pair.turns * around
    section = COPPER_RESISTIVITY * length / pair.resistance
    side = math.sqrt(pair.turns * section / FILL)
    conductance = COOLING * 2.0 * 4.0 * side * around
    constant = COPPER_HEAT * length * section / conductance
    return math.sqrt(conductance * WARMING / pair.resistance), constant
