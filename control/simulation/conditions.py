"""What can be done to a simulated board's electrics, by name: the same for the twin and the emulated board."""

from __future__ import annotations

from dataclasses import dataclass

COILS = (1, 2, 3)
"""Coils as they are marked on the board."""


class ConditionRefused(ValueError):
    """A condition that there is not; the text says what there is."""


@dataclass(frozen=True, slots=True)
class Condition:
    """One thing that may be otherwise than it should.

    name: with the unit.  per_coil: whether it belongs to one coil.  least, most: allowed values.
    """

    name: str
    per_coil: bool
    least: int
    most: int
    meaning: str


_ALL = (
    Condition("supply_mV", False, 0, 65_000, "the bridges' supply; 0 is switched off"),
    Condition("driver_fault", True, 0, 1, "the bridge is off and pulls its EN/DIAG line low"),
    Condition("sense_permille", True, 0, 10_000, "what the current sense shows: 1000 is true, 0 is dead"),
    Condition("open_coil", True, 0, 1, "a lead is broken: no current"),
    Condition("resistance_mohm", True, 100, 100_000, "the coil's true resistance"),
    Condition("swapped", True, 0, 1, "the leads are exchanged: the current is reversed"),
)
CONDITIONS = {condition.name: condition for condition in _ALL}


def checked(name: str, value: int, coil: int | None) -> Condition:
    """The condition of that name; ConditionRefused unless it may have this value at this coil."""
    condition = CONDITIONS.get(name)
    if condition is None:
        raise ConditionRefused(f"there is no condition {name!r}; there are: {', '.join(CONDITIONS)}")
    if condition.per_coil and coil not in COILS:
        raise ConditionRefused(f"{name} belongs to one coil, 1, 2 or 3; given: {coil!r}")
    if not condition.per_coil and coil is not None:
        raise ConditionRefused(f"{name} belongs to the board, not to a coil; given: coil {coil!r}")
    if isinstance(value, bool) or not isinstance(value, int):
        raise ConditionRefused(f"{name} is {value!r}; it must be a whole number")
    if not condition.least <= value <= condition.most:
        raise ConditionRefused(f"{name} is {value}; allowed is {condition.least} to {condition.most}")
    return condition
