"""Open loop: a table of pivot, sweep and rate, carried out row by row."""

from __future__ import annotations

import math
from dataclasses import dataclass

from pydantic import Field, field_validator

from control.controllers.controller import Decision, Situation, controllers
from control.model import PIVOT_A, PIVOT_B, Pivot
from control.registry import Parameters

LONGEST_TABLE = 1000
FASTEST = math.radians(360.0)
"""Rates stay below this, rad/s."""
WIDEST = math.radians(3600.0)
"""Widest turn of one row, rad."""
DONE_WITHIN = math.radians(0.3)
"""What is left of a row once its sweeps are complete and it still counts as done: the noise of one sighting."""
_PIVOTS: dict[str, Pivot] = {"A": PIVOT_A, "B": PIVOT_B}


@dataclass(frozen=True, slots=True)
class Row:
    """Stand on `pivot` and turn by `angle` (rad, signed) at `rate` (rad/s, > 0)."""

    pivot: Pivot
    angle: float
    rate: float


class SequenceParameters(Parameters):
    table: str = Field(
        default="B 15 60; A -30 60; B 30 60; A -30 60; B 30 60",
        max_length=40_000,
        title="Table",
        description="Rows of pivot (A or B), turn in degrees (positive is counter-clockwise) and rate in degrees "
        "per second, parted by semicolons.",
    )
    repeat: bool = Field(default=False, title="Repeat", description="Start again after the last row.")

    @field_validator("table")
    @classmethod
    def _is_a_table(cls, table: str) -> str:
        parse_table(table)
        return table


def parse_table(table: str) -> tuple[Row, ...]:
    """The rows of `B 15 60; A -30 60`; raises ValueError with the number of the row that is wrong."""
    texts = [text.split() for text in table.replace("\n", ";").split(";") if text.strip()]
    if not 1 <= len(texts) <= LONGEST_TABLE:
        raise ValueError(f"the table has {len(texts)} rows; 1 to {LONGEST_TABLE} are allowed")
    return tuple(_row(number, cells) for number, cells in enumerate(texts, start=1))


def _row(number: int, cells: list[str]) -> Row:
    try:
        pivot, angle, rate = cells
        row = Row(_PIVOTS[pivot.upper()], math.radians(float(angle)), math.radians(float(rate)))
    except (KeyError, ValueError):
        row = None
    if row is None or not (0.0 < abs(row.angle) <= WIDEST and 0.0 < row.rate < FASTEST):
        raise ValueError(
            f"row {number}, {' '.join(cells)!r}, is not understood: write A or B, a turn other than 0 within "
            f"±{math.degrees(WIDEST):.0f}° and a rate above 0 and below {math.degrees(FASTEST):.0f} °/s, "
            "such as: A -30 60"
        )
    return row


@controllers.register
class Sequence:
    """A turn that is wider than the gait's sweep is made in several sweeps on the same pivot."""

    name = "sequence"
    title = "Sequence"
    summary = "Carries out a table of pivot, turn and rate, without looking at the path."
    Parameters = SequenceParameters

    def __init__(self, parameters: SequenceParameters) -> None:
        self._rows = parse_table(parameters.table)
        self._repeat = parameters.repeat
        self._next = 0
        self._goal: float | None = None
        self._sweep: float | None = None

    def step(self, situation: Situation) -> Decision:
        if situation.may_switch:
            if not self._advance(situation.pose.heading):
                return Decision(situation.pivot, 0.0, finished=True)
            self._sweep = min(situation.gait.sweep, self._left(situation.pose.heading))
        row = self._rows[self._next]
        return Decision(row.pivot, math.copysign(row.rate, row.angle), self._sweep)

    def _left(self, heading: float) -> float:
        """What is left of the row in hand, rad; infinite before the first one."""
        if self._goal is None:
            return math.inf
        return (self._goal - heading) * math.copysign(1.0, self._rows[self._next].angle)

    def _advance(self, heading: float) -> bool:
        """Take up the next row when this one is done; False after the last one."""
        if self._goal is not None:
            if self._left(heading) > DONE_WITHIN:
                return True
            if self._next + 1 == len(self._rows) and not self._repeat:
                return False
            self._next = (self._next + 1) % len(self._rows)
        self._goal = heading + self._rows[self._next].angle
        return True
