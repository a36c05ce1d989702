"""What can go wrong with the board, its bridges, the supply and the coils."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Literal

from pydantic import Field

from control.registry import Parameters
from control.simulation.faults.kind import WHEN_TAKEN_AWAY, Family, FaultKind, quantity
from control.simulation.faults.points import FaultPoints

Axis = Annotated[
    Literal["x", "y", "z"], Field(title="Coil", description="The pair of coils along this axis.")
]
AXES = "xyz"
MV = 1e3
MOHM = 1e3


class OneCoil(Parameters):
    coil: Axis = "x"


class Supply(Parameters):
    supply_V: float = quantity(8.0, "V", 0.0, 60.0, "What is left of the supply")


class Sense(OneCoil):
    shows_percent: float = quantity(300.0, "%", 0.0, 1000.0, "What the current sense shows of the current")


class Resistance(OneCoil):
    resistance_ohm: float = quantity(10.0, "ohm", 0.1, 100.0, "Resistance of coil and leads")


def _supply(points: FaultPoints, millivolts: int) -> None:
    points.board.set_condition("supply_mV", millivolts)


def _sense(points: FaultPoints, coil: str, permille: int) -> None:
    points.board.set_condition("sense_permille", permille, _number(coil))


def _set_back(name: str, value: int) -> Callable[[FaultPoints], None]:
    """Sets a condition of all three coils back."""

    def put_back(points: FaultPoints) -> None:
        for coil in AXES:
            points.board.set_condition(name, value, _number(coil))

    return put_back


def _put_back_resistances(points: FaultPoints) -> None:
    for coil, resistance in zip(AXES, points.nominal.resistances, strict=True):
        points.board.set_condition("resistance_mohm", resistance, _number(coil))


def _number(coil: str) -> int:
    """The coil's number on the board."""
    return AXES.index(coil) + 1


def _at_coil(name: str, value: int) -> Callable[[FaultPoints, OneCoil], None]:
    """Sets a condition of the coil that the parameters name."""
    return lambda points, one: points.board.set_condition(name, value, _number(one.coil))


KINDS = (
    FaultKind(
        "board_reset", 13, Family.BOARD, "Board resets",
        "The board starts anew, as by its reset button or a dip of its USB supply.",
        "at once: the board is greeted and configured again, and stays without current",
        lambda points, _: points.board.reset(), happens_once=True,
    ),
    FaultKind(
        "supply_off", 14, Family.BOARD, "Supply off",
        "The coils' supply is switched off while the board lives on from USB.",
        "when the supply is on again; arm anew",
        lambda points, _: _supply(points, 0), lambda points: _supply(points, points.nominal.supply),
    ),
    FaultKind(
        "supply_low", 14, Family.BOARD, "Supply low",
        "The coils' supply sags.",
        "when the supply is up again; arm anew",
        lambda points, supply: _supply(points, round(supply.supply_V * MV)),
        lambda points: _supply(points, points.nominal.supply), Supply,
    ),
    FaultKind(
        "driver_fault", 14, Family.BOARD, "Driver fault",
        "A motor driver shuts itself off: too hot, short circuit or supply out of its range.",
        "when the driver is well again; reset and arm anew",
        _at_coil("driver_fault", 1), _set_back("driver_fault", 0), OneCoil,
    ),
    FaultKind(
        "coil_open", 14, Family.BOARD, "Coil's lead broken",
        "A lead of one pair of coils comes off.",
        "when the lead is on again; arm anew",
        _at_coil("open_coil", 1), _set_back("open_coil", 0), OneCoil,
    ),
    FaultKind(
        "sense_dead", 14, Family.BOARD, "Current sense dead",
        "The current sense of one driver shows nothing.",
        "when the sense works again; arm anew",
        _at_coil("sense_permille", 0), _set_back("sense_permille", 1000), OneCoil,
    ),
    FaultKind(
        "sense_wrong", 21, Family.BOARD, "Over-current",
        "The current sense of one driver shows much more than flows, as a short circuit would.",
        "when the sense is right again; reset and arm anew",
        lambda points, sense: _sense(points, sense.coil, round(sense.shows_percent * 10.0)),
        _set_back("sense_permille", 1000), Sense,
    ),
    FaultKind(
        "coil_resistance", 14, Family.BOARD, "Coil's resistance",
        "The resistance of one pair of coils is another than the rig file's: a bad contact, or another coil.",
        WHEN_TAKEN_AWAY,
        lambda points, wrong: points.board.set_condition(
            "resistance_mohm", round(wrong.resistance_ohm * MOHM), _number(wrong.coil)
        ),
        _put_back_resistances, Resistance,
    ),
    FaultKind(
        "coil_swapped", 4, Family.BOARD, "Coil's leads exchanged",
        "The two leads of one pair of coils are exchanged: its field points the other way.",
        "when the leads are right again; arm anew",
        _at_coil("swapped", 1), _set_back("swapped", 0), OneCoil,
    ),
)  # fmt: skip
