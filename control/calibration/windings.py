"""Windings and current sense: what the board's own figures, and an ammeter, say of each coil.

A steady coil has only its resistance: R = duty * supply / I. The driver's current sense is off by up to 25 %
and differs by direction (firmware-notes.md), so an ammeter in the lead is worth its minute: the sense gain
of a channel and direction is the ammeter's current over the sense's, times the gain that the board had.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from control.axes import AXES, Axis
from control.coils import CoilPair

RESISTANCE_TOLERANCE = 0.15
"""A resistance may differ by this share from the rig file's: a winding 38 K warmer than when it was measured."""
OPEN_SHARE = 0.1
"""A coil that carries less than this share of what is asked of it, by its sense, has an open lead or no sense."""
UNMEASURED = "if an ohmmeter says so too, write it into the rig file"

LEAST_AMMETER = 0.5
"""Smallest current worth comparing, A: 14 counts of the sense."""
SENSE_TOLERANCE = 0.35
"""The driver's sense is known to be off by 25 % and not by more than this share."""


class BadAmmeter(ValueError):
    """Ammeter readings that make no sense; the text says which and why."""


SenseGains = tuple[float, float]
"""A per count for positive and for negative current."""


def without_cut_off(sensed: float, gains: SenseGains) -> float:
    """A sensed current (A) less what the converter cuts off, half a count on average; zero stays zero."""
    if sensed == 0.0:
        return 0.0
    return sensed + (0.5 * gains[0] if sensed > 0.0 else -0.5 * gains[1])


@dataclass(frozen=True, slots=True)
class SteadyCoil:
    """One coil carrying one current. wanted, sensed: A, signed.  voltage: duty times supply, V, signed."""

    coil: Axis
    wanted: float
    sensed: float
    voltage: float


@dataclass(frozen=True, slots=True)
class WindingCheck:
    """resistance: measured, ohm; inf when the coil carries nothing.  due: the rig file's, ohm.

    complaint: what is wrong and the likely cause, "" when nothing is.
    """

    coil: Axis
    resistance: float
    due: float
    complaint: str

    @property
    def deviation(self) -> float:
        """Share by which the resistance differs from the rig file's."""
        return self.resistance / self.due - 1.0


def check_windings(pairs: Sequence[CoilPair], steady: Sequence[SteadyCoil]) -> list[WindingCheck]:
    """Each measured pair's resistance against the rig file's."""
    checks = []
    for pair in pairs:
        own = [each for each in steady if each.coil == pair.axis]
        if own:
            resistance = _resistance(own)
            checks.append(
                WindingCheck(pair.axis, resistance, pair.resistance, _complaint(pair, resistance, pairs))
            )
    return checks


def _resistance(own: Sequence[SteadyCoil]) -> float:
    """Least squares of the voltages over the sensed currents, ohm; inf when next to nothing flows."""
    square = sum(each.sensed**2 for each in own)
    if not square > OPEN_SHARE**2 * sum(each.wanted**2 for each in own):
        return math.inf
    return sum(abs(each.voltage * each.sensed) for each in own) / square


def _complaint(pair: CoilPair, resistance: float, pairs: Sequence[CoilPair]) -> str:
    name = f"the {pair.axis} coils"
    if math.isinf(resistance):
        return f"{name} carry no current that is sensed: an open lead, or the sense line of this channel"
    deviation = resistance / pair.resistance - 1.0
    if abs(deviation) <= RESISTANCE_TOLERANCE:
        return ""
    found = (
        f"{name} have {resistance:.2f} ohm where the rig file says {pair.resistance:.2f} ({deviation:+.0%})"
    )
    for other in pairs:
        if other.axis != pair.axis and abs(resistance / other.resistance - 1.0) <= 0.5 * RESISTANCE_TOLERANCE:
            return f"{found}: that is what the {other.axis} coils have; are they exchanged?"
    if deviation < 0.0:
        causes = "turns are shorted, one coil of the pair is not in series, or the sense reads high"
    else:
        causes = "a hot winding, a bad contact, or a sense that reads low"
    return f"{found}: {causes}; {UNMEASURED}"


@dataclass(frozen=True, slots=True)
class AmmeterReading:
    """coil: channel.  sensed: what the board reports, A, signed.  ammeter: what the meter in the lead shows, A."""

    coil: Axis
    sensed: float
    ammeter: float


def calibrate_sense(
    gains: dict[Axis, SenseGains], readings: Sequence[AmmeterReading]
) -> dict[Axis, SenseGains]:
    """The sense gains (A per count) that make the board's currents the ammeter's; raises `BadAmmeter`.

    A channel or direction that was not measured keeps its gain.
    """
    for reading in readings:
        _check_ammeter(reading)
    found: dict[Axis, SenseGains] = {}
    for axis in AXES:
        positive, negative = gains[axis]
        found[axis] = (
            positive * _ratio([r for r in readings if r.coil == axis and r.sensed > 0.0]),
            negative * _ratio([r for r in readings if r.coil == axis and r.sensed < 0.0]),
        )
    return found


def _check_ammeter(reading: AmmeterReading) -> None:
    name = f"the {reading.coil} coils at {reading.sensed:+.2f} A (sensed)"
    if not (math.isfinite(reading.sensed) and abs(reading.sensed) >= LEAST_AMMETER):
        raise BadAmmeter(f"{name}: at least {LEAST_AMMETER:g} A are needed to compare; use a larger current")
    ratio = reading.ammeter / reading.sensed
    if ratio < 0.0:
        raise BadAmmeter(
            f"{name}: the ammeter shows {reading.ammeter:+.2f} A, the other direction; swap its leads, or the coil's"
        )
    if not abs(ratio - 1.0) <= SENSE_TOLERANCE:
        raise BadAmmeter(
            f"{name}: the ammeter shows {reading.ammeter:+.2f} A; a sense is off by {SENSE_TOLERANCE:.0%} at most: "
            "check the ammeter's range and that it is in this coil's lead"
        )


def _ratio(readings: Sequence[AmmeterReading]) -> float:
    """Ammeter over sense, by least squares; 1 without readings."""
    if not readings:
        return 1.0
    return sum(r.ammeter * r.sensed for r in readings) / sum(r.sensed**2 for r in readings)
