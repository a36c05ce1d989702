"""What a pivot switch does to the robot, as measured on a rigid-body model of the gait."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import astuple, dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Slip:
    """The slip at one tilt of the field; each mean comes with the deviation (sd) of its Gaussian scatter.

    tilt: elevation of the settled field, rad.
    play: the free play between the field's heading and the body's, full width, rad.
    out: how far the new pivot lands from its place, along the link away from the centre, m.
    forward_base, forward_per_sweep: how far it lands in the walking direction, m + m/rad * sweep.
    """

    tilt: float
    play: float
    play_sd: float
    out: float
    out_sd: float
    forward_base: float
    forward_per_sweep: float
    forward_sd: float

    def scaled(self, factor: float) -> Slip:
        """The same for a robot `factor` times as long."""
        return Slip(
            self.tilt,
            self.play,
            self.play_sd,
            factor * self.out,
            factor * self.out_sd,
            factor * self.forward_base,
            factor * self.forward_per_sweep,
            factor * self.forward_sd,
        )


@dataclass(frozen=True, slots=True)
class SlipParameters:
    """rows: by rising tilt, for a robot of `reference_length` (m).

    magnetic_ratio: the paper's robot in one number, Lambda = 2 m B / (W L), at `reference_field` (T).
    """

    rows: tuple[Slip, ...]
    magnetic_ratio: float = 3.2
    reference_field: float = 10e-3
    reference_length: float = 10e-3

    def __post_init__(self) -> None:
        tilts = [row.tilt for row in self.rows]
        if not tilts or any(not low < high for low, high in pairwise(tilts)):
            raise ValueError(f"a slip table needs rows by rising tilt, got tilts {tilts} rad")

    def at(self, tilt: float, length: float) -> Slip:
        """The slip at `tilt` (rad), linear between rows, the end rows beyond; for a robot of `length` (m)."""
        low, share = between_rows([row.tilt for row in self.rows], tilt)
        if share == 0.0:
            return self.rows[low].scaled(length / self.reference_length)
        pairs = zip(astuple(self.rows[low]), astuple(self.rows[low + 1]), strict=True)
        mean = Slip(*(mixed(start, end, share) for start, end in pairs))
        return mean.scaled(length / self.reference_length)


def between_rows(tilts: Sequence[float] | NDArray[np.float64], tilt: float) -> tuple[int, float]:
    """The row below `tilt` (rad) and the share of the way to the next one; 0 beyond the ends of the table."""
    last = len(tilts) - 1
    if not tilt > tilts[0]:
        return 0, 0.0
    for low in range(last):
        if tilt <= tilts[low + 1]:
            return low, (tilt - tilts[low]) / (tilts[low + 1] - tilts[low])
    return last, 0.0


def mixed(start: float, end: float, share: float) -> float:
    """The value at `share` of the way."""
    return start * (1.0 - share) + end * share


def _row(
    tilt_deg: float, play_deg: tuple[float, float], out_mm: tuple[float, float], forward: tuple[float, ...]
) -> Slip:
    base_mm, per_sweep_mm, sd_mm = forward
    return Slip(
        tilt=math.radians(tilt_deg),
        play=math.radians(play_deg[0]),
        play_sd=math.radians(play_deg[1]),
        out=out_mm[0] * 1e-3,
        out_sd=out_mm[1] * 1e-3,
        forward_base=base_mm * 1e-3,
        forward_per_sweep=per_sweep_mm * 1e-3,
        forward_sd=sd_mm * 1e-3,
    )


# Fitted to a rigid-body study (MuJoCo) of a robot with L = 10 mm, friction 0.5, Lambda = 3.2, elevation ramp
# 50 ms, sweeps of 15 to 40 degrees. Columns: tilt (deg); play b (deg) with sd; out (mm) with sd;
# forward f0 (mm), f1 (mm/rad), sd (mm).
SLIP_TABLE = SlipParameters(
    rows=(
        _row(10.0, (11.45, 2.67), (0.010, 0.042), (0.069, -0.172, 0.132)),
        _row(15.0, (6.81, 1.48), (0.044, 0.027), (0.012, 0.103, 0.045)),
        _row(20.0, (3.41, 0.87), (-0.076, 0.019), (-0.080, 0.555, 0.036)),
        _row(22.5, (3.05, 0.84), (-0.129, 0.038), (0.007, 0.517, 0.049)),
        _row(24.5, (2.95, 0.94), (-0.147, 0.055), (0.084, 0.447, 0.071)),
        _row(27.5, (2.93, 1.07), (-0.150, 0.085), (0.221, 0.280, 0.101)),
        _row(30.0, (2.87, 1.09), (-0.192, 0.106), (0.304, 0.147, 0.115)),
        _row(35.0, (2.73, 1.09), (-0.286, 0.303), (0.381, -0.036, 0.145)),
    )
)

NO_SLIP = SlipParameters(rows=(Slip(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),))
"""The paper's kinematic model: the body's heading is the field's, each pivot stays where it lands."""
