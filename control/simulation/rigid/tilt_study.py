"""Why the rigid robot walks best at some tilt: its pivot switches over the tilt, for weak and strong magnets.

Below Lambda sin(tilt) = 1 both ends stay on the plate and friction holds the body back (yaw backlash); far above it
the new pivot hops outward at the switch, the more the quicker the elevation swings over. The best tilt lies between,
where the assumed Lambda puts it: it is a property of the assumed robot, and predicts nothing of another one.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from control.simulation.gait_survey import Stride, SwitchFigures, survey
from control.simulation.plants import PlantChoice
from control.simulation.rigid.parameters import RigidParameters
from control.simulation.slip import SLIP_TABLE, Slip

LENGTH = 10e-3
"""The paper's robot, m."""
RATIOS = (2.0, 2.6, 3.2, 7.0, 14.0)
"""Lambda, from a magnet that hardly lifts to one much stronger than needed."""
RAMPS = (0.050, 0.150)
"""Of the elevation at a switch, s: the board's default, and one that is three times as gentle."""
TILTS = tuple(math.radians(tilt) for tilt in (10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0))
SWITCHES = 10
SEEDS = (1, 2)
"""Two plates of uneven friction."""

TABLE_SEEDS = (1, 2, 3, 4)
TABLE_ROBOT = RigidParameters(adhesion_mN=0.0, friction=0.5)
"""The robot of the slip table as far as it is known: friction 0.5, held down by its weight alone (assumed)."""


@dataclass(frozen=True, slots=True)
class TiltPoint:
    """ratio: Lambda.  ramp: s.  tilt: rad."""

    ratio: float
    ramp: float
    tilt: float
    figures: SwitchFigures

    @property
    def lift(self) -> float:
        """Lambda sin(tilt): above 1 the free end lifts."""
        return self.ratio * math.sin(self.tilt)


@dataclass(frozen=True, slots=True)
class TableRow:
    """One row of the slip table beside what the rigid plant gives for the same tilt."""

    table: Slip
    rigid: SwitchFigures


def tilt_study(
    ratios: Iterable[float] = RATIOS,
    ramps: Sequence[float] = RAMPS,
    tilts: Sequence[float] = TILTS,
    switches: int = SWITCHES,
    seeds: Sequence[int] = SEEDS,
) -> Iterator[TiltPoint]:
    """One point after the other, so that progress can be shown; raises `MissingExtra`."""
    for ratio in ratios:
        choice = rigid_with(RigidParameters(), ratio)
        for ramp in ramps:
            for tilt in tilts:
                stride = Stride(tilt=tilt, ramp=ramp)
                yield TiltPoint(ratio, ramp, tilt, survey(choice, LENGTH, stride, switches, seeds))


def beside_the_table(
    rows: Sequence[Slip] = SLIP_TABLE.rows, switches: int = SWITCHES, seeds: Sequence[int] = TABLE_SEEDS
) -> Iterator[TableRow]:
    """Each row of the slip table, and the rigid robot at the table's Lambda; nothing is fitted."""
    choice = rigid_with(TABLE_ROBOT, SLIP_TABLE.magnetic_ratio)
    for row in rows:
        yield TableRow(row, survey(choice, LENGTH, Stride(tilt=row.tilt), switches, seeds))


def rigid_with(parameters: RigidParameters, ratio: float) -> PlantChoice:
    """The rigid plant with the magnet for this Lambda."""
    return PlantChoice("rigid", parameters.with_magnetic_ratio(ratio, LENGTH).model_dump())
