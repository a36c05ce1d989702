"""Registration of the camera's frame to the coils': from headings of field and robot to rotation and polarity.

The robot lies along the field with a play p: seen heading less the field's is d - s p/2, with s the direction
of the last turn and d the angle between the frames. A turn to the left and back to the right tells both.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from control.calibration.turning import Station, Unclear
from control.model import wrap
from control.registration import Registration

FEWEST_STATIONS = 8
"""Four headings each way: with fewer, what is uneven about the coils looks like a rotation."""
WORST_RESIDUAL = math.radians(5.0)
"""Headings may scatter by this, rad: the camera's share is 0.35 degrees, the play's own scatter 1."""


@dataclass(frozen=True, slots=True)
class HeadingOffset:
    """offset: seen heading less the field's, rad in [-pi, pi).  standard_error, residual (rms), play: rad."""

    offset: float
    standard_error: float
    residual: float
    play: float
    stations: int


def heading_offset(stations: Sequence[Station]) -> HeadingOffset:
    """The angle between field and robot by circular least squares; raises `Unclear`."""
    if len(stations) < FEWEST_STATIONS or {s.direction for s in stations} != {-1, 1}:
        raise Unclear(
            f"{len(stations)} headings were seen, {FEWEST_STATIONS} and turns both ways are needed; "
            "let the robot turn further"
        )
    differences = [wrap(s.pose.heading - s.field_heading) for s in stations]
    middle = math.atan2(sum(map(math.sin, differences)), sum(map(math.cos, differences)))
    rest = np.array([wrap(difference - middle) for difference in differences])
    design = np.array([[1.0, -0.5 * s.direction] for s in stations])
    (shift, play), *_ = np.linalg.lstsq(design, rest, rcond=None)
    misses = rest - design @ np.array([shift, play])
    residual = math.sqrt(float(misses @ misses) / (len(stations) - 2))
    if not residual <= WORST_RESIDUAL:
        raise Unclear(
            f"the headings scatter by {math.degrees(residual):.1f} degrees, allowed are "
            f"{math.degrees(WORST_RESIDUAL):g}: the robot sticks, or the picture is distorted"
        )
    inverse = np.linalg.inv(design.T @ design)
    return HeadingOffset(
        offset=wrap(middle + float(shift)),
        standard_error=residual * math.sqrt(float(inverse[0, 0])),
        residual=residual,
        play=float(play),
        stations=len(stations),
    )


def with_names_as(fine: float, coarse: float) -> float:
    """`fine` (rad), or half a turn from it, whichever is nearer to `coarse`, in which the ends' names are sure."""
    return fine if abs(wrap(fine - coarse)) <= 0.5 * math.pi else wrap(fine + math.pi)


def corrected(old: Registration, offset: float, magnet_reversed: bool) -> Registration:
    """The registration after which field and robot agree.

    offset: as seen under the old one, rad.  magnet_reversed: the magnet lies the other way than `old` has it.
    """
    turned = wrap(offset + math.pi) if magnet_reversed else offset
    return replace(
        old, rotation=wrap(old.rotation + turned), magnet_reversed=old.magnet_reversed != magnet_reversed
    )
