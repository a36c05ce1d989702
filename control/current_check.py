"""Whether the coils carry what is commanded, and if not, what that looks like; pure.

The board regulates the sensed current, so what is sensed is what is commanded unless something is broken. A
coil that shows nothing has an open lead or a dead sense: the board cannot tell these apart, the robot can.
"""

from __future__ import annotations

from dataclasses import dataclass

from control.axes import AXES
from control.snapshot import Vector

MISMATCH_SHARE = 0.15
"""Sensed and commanded current may differ by this share of the limit: the sense is off by up to 25 % of a
small current, and the coils lag behind a ramp (firmware-notes.md)."""
NOTHING_SHARE = 0.05
"""A sense that shows less than this share of the limit shows nothing: 0.4 A of 8 A, twelve counts."""


@dataclass(frozen=True, slots=True)
class Mismatch:
    """code: "supply", "coil" or "sense", "" where all agrees.  message: what to do."""

    code: str
    message: str


AGREED = Mismatch("", "")


def compare(commanded: Vector, sensed: Vector, limits: Vector, *, supply_is_sensed: bool) -> Mismatch:
    """How the sensed currents (A, the sign is the board's guess) differ from the commanded ones (A)."""
    coils = list(zip(AXES, commanded, sensed, limits, strict=True))
    wrong = [coil for coil in coils if not abs(abs(coil[1]) - abs(coil[2])) <= MISMATCH_SHARE * coil[3]]
    if not wrong:
        return AGREED
    asked = [axis for axis, wanted, _, limit in coils if not abs(wanted) <= MISMATCH_SHARE * limit]
    dead = [axis for axis, _, seen, limit in wrong if abs(seen) < NOTHING_SHARE * limit]
    if dead == asked and (len(asked) > 1 or not supply_is_sensed):
        return _none_at_all(supply_is_sensed)
    if dead:
        return _no_current(dead)
    return _other(wrong[0])


def _none_at_all(supply_is_sensed: bool) -> Mismatch:
    if supply_is_sensed:
        message = "no coil shows a current although the supply is on: check the current sense's wires and the bridges"
        return Mismatch("sense", message)
    return Mismatch("supply", "no coil shows a current: is the supply of the coils on?")


def _no_current(dead: list[str]) -> Mismatch:
    message = (
        f"coil {' and '.join(dead)} shows no current: check its leads; if it does turn the robot, its current "
        "sense is dead"
    )
    return Mismatch("coil", message)


def _other(coil: tuple[str, float, float, float]) -> Mismatch:
    axis, wanted, seen, _ = coil
    message = (
        f"coil {axis} shows {abs(seen):.2f} A where {abs(wanted):.2f} A are commanded: check its leads, its "
        "resistance in the rig file and the calibration of its current sense"
    )
    return Mismatch("sense", message)
