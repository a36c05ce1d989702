"""Slip identification: from what the camera saw of a walk to the gait's figures, each with its uncertainty.

While the robot stands on one pivot its centre moves on an arc about it, so all arcs together give the length;
where one arc ends and the next begins gives what the switch did; how far the field led the body gives the
play. Pure: samples in, a `GaitModel` out.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from control.gait_model import GaitModel, GaitUncertainty
from control.model import PIVOT_A, PIVOT_B, TURN, Pivot, Pose

Array = NDArray[np.float64]

FEWEST_STANDS = 12
"""Turns about a pivot that an identification needs."""
FEWEST_SIGHTINGS = 5
"""In one turn about a pivot: two in each half and one to spare."""
LEAST_TURN = math.radians(8.0)
"""A turn of the field that is smaller may leave the body behind altogether, rad (play at a tilt of 20: 3.4)."""
SETTLED_WITHIN = math.radians(0.5)
"""The elevation is at its end, rad."""
CAMERA_SCALE = 0.003
"""Standard error of the camera's scale: 1 mm in the height of the robot's top below a camera at 350 mm."""
CAMERA_HEADING = math.radians(0.1)
"""Standard error of seen headings that does not average out, rad (measured on the simulated camera: 0.05)."""
LONGEST_SWITCH = 0.4
"""Two turns that are further apart in time, s, do not belong to one switch (ramp: 50 ms; camera: 60 Hz)."""


FEWEST_SWITCHES = 8
BLOCKS = 20
"""Of the jackknife: neighbouring turns share their switches, so they are left out together."""
_FIGURES = ("length", "out", "forward_base", "forward_per_sweep", "backlash", "heading_offset", "lag", "skew")


class TooLittle(ValueError):
    """The walk does not show enough."""


@dataclass(frozen=True, slots=True)
class Sample:
    """One sighting. time: of its capture, s.  pose: as seen.  field_heading, elevation: of the field then, rad."""

    time: float
    pose: Pose
    field_heading: float
    elevation: float


@dataclass(frozen=True, slots=True)
class Stand:
    """One turn about one pivot, as seen; arrays over its sightings.

    lead: field's heading less the body's, on average over the half of the turn in which the field surely pulls,
    rad.  rate: of the field in that half, rad/s, signed.
    rest, rest_lead: the body's heading and the field's lead while the field holds still before it presses on the
    other pivot, rad; NaN when the camera saw nothing of that.
    """

    pivot: Pivot
    start: float
    end: float
    centre: Array
    heading: Array
    lead: float
    rate: float
    rest: float
    rest_lead: float

    @property
    def direction(self) -> float:
        return math.copysign(1.0, self.rate)


@dataclass(frozen=True, slots=True)
class _Arm:
    """From a pivot to the centre, in the axes of the seen heading, m: across (the length's half) and along."""

    across: float
    along: float

    @property
    def length(self) -> float:
        return 2.0 * math.hypot(self.across, self.along)

    @property
    def skew(self) -> float:
        """The body's true heading less the seen one, rad."""
        return math.atan2(self.along, self.across)


def identify(samples: Sequence[Sample], switch_time: float = 0.0) -> GaitModel:
    """The gait's figures from the sightings of one walk at one tilt; raises `TooLittle`.

    switch_time: how long the field's ramp between the pivots takes, s; it is known, not identified.
    """
    stands = stands_of(samples)
    if len(stands) < FEWEST_STANDS:
        raise TooLittle(
            f"the walk shows {len(stands)} usable turns about a pivot, {FEWEST_STANDS} are needed; walk further"
        )
    values, errors = _jackknife(stands)
    return GaitModel(
        **dict(zip(_FIGURES, values.tolist(), strict=True)),
        switch_time=switch_time,
        uncertainty=_uncertainty(float(values[0]), errors),
    )


def _uncertainty(length: float, errors: Array) -> GaitUncertainty:
    """The walk's own scatter, and what the camera may get wrong in the same way all along."""
    scale, turn = CAMERA_SCALE * length, CAMERA_HEADING
    of_camera = np.array([scale, scale, turn * length, 0.0, 2.0 * turn, turn, 0.0, turn])
    return GaitUncertainty(**dict(zip(_FIGURES, np.hypot(errors, of_camera).tolist(), strict=True)))


def stands_of(samples: Sequence[Sample]) -> list[Stand]:
    """The usable turns about a pivot, in the order of time."""
    tilt = max((abs(sample.elevation) for sample in samples), default=0.0)
    groups = [(key, list(group)) for key, group in itertools.groupby(samples, lambda s: _phase(s, tilt))]
    found = []
    for (key, group), (next_key, after) in itertools.pairwise([*groups, ((None, False), [])]):
        pivot, settled = key
        if pivot is not None and settled:
            found.append(_stand(pivot, group, after if next_key == (pivot, False) else []))
    return [stand for stand in found if stand is not None]


def _phase(sample: Sample, tilt: float) -> tuple[Pivot | None, bool]:
    """The pivot that the field presses down, and whether it has settled or is on its way to the other one."""
    pivot = PIVOT_B if sample.elevation > 0.0 else PIVOT_A
    return pivot, tilt - abs(sample.elevation) <= SETTLED_WITHIN


def _stand(pivot: Pivot, samples: list[Sample], resting: list[Sample]) -> Stand | None:
    """None for a turn that is too short, too small, or to and fro."""
    times, field, heading = _columns(samples)
    turned = np.abs(field - field[0])
    tight = turned >= 0.5 * turned[-1]
    moves = np.diff(field)
    if len(samples) < FEWEST_SIGHTINGS or turned[-1] < LEAST_TURN or tight.sum() < 2:
        return None
    if (moves > 0.0).any() and (moves < 0.0).any():
        return None
    _, held, still = _columns(resting)
    return Stand(
        pivot=pivot,
        start=samples[0].time,
        end=samples[-1].time,
        centre=np.array([[sample.pose.x, sample.pose.y] for sample in samples]),
        heading=heading,
        lead=float((field - heading)[tight].mean()),
        rate=float(np.polyfit(times[tight] - times[0], field[tight], 1)[0]),
        rest=float(still.mean()) if resting else math.nan,
        rest_lead=float((held - still).mean()) if resting else math.nan,
    )


def _columns(samples: list[Sample]) -> tuple[Array, Array, Array]:
    """Times (s), the field's headings and the body's, unwrapped along the field's (rad)."""
    times = np.array([sample.time for sample in samples])
    field = np.array([sample.field_heading for sample in samples])
    seen = np.array([sample.pose.heading for sample in samples])
    return times, field, field - ((field - seen + math.pi) % TURN - math.pi)


def _figures(stands: Sequence[Stand]) -> Array:
    """All of `_FIGURES` from some of the turns; raises `TooLittle`."""
    arm = _fit_arm(stands)
    switches = [_switch(*pair, arm) for pair in itertools.pairwise(stands) if _is_switch(*pair)]
    if len(switches) < FEWEST_SWITCHES:
        raise TooLittle(
            f"the walk shows {len(switches)} usable switches of the pivot, {FEWEST_SWITCHES} are needed; "
            "walk further, or with a camera that gives more pictures a second"
        )
    outs, forwards, turns = np.array(switches).T
    base, per_sweep = _solve(np.column_stack([np.ones_like(turns), turns]), forwards)
    return np.array([arm.length, outs.mean(), base, per_sweep, *_play(stands), arm.skew])


def _play(stands: Sequence[Stand]) -> tuple[float, float, float]:
    """Backlash (rad), heading offset (rad) and lag (s): at rest the field leads by half the play, to the side it
    came from, and by the offset; while it turns, by the lag's worth more."""
    seen = [stand for stand in stands if not math.isnan(stand.rest)]
    leads = np.array([stand.rest_lead for stand in seen])
    backlash, offset = _solve(np.array([[0.5 * stand.direction, 1.0] for stand in seen]), leads)
    rates = np.array([stand.rate for stand in seen])
    more = np.array([stand.lead for stand in seen]) - leads
    return float(backlash), float(offset), float(rates @ more / (rates @ rates))


def _solve(design: Array, values: Array) -> Array:
    """Least squares; what the walk does not show (one sweep only, say) is shared out evenly, not made up."""
    return np.asarray(np.linalg.lstsq(design, values, rcond=1e-3)[0], dtype=np.float64)


def _axes(heading: Array) -> tuple[Array, Array]:
    """Unit vectors (n, 2) across the body, against the local y_R, and along it, the heading x_R."""
    sine, cosine = np.sin(heading), np.cos(heading)
    return np.column_stack([sine, -cosine]), np.column_stack([cosine, sine])


def _fit_arm(stands: Sequence[Stand]) -> _Arm:
    """Centre = pivot + sigma (across n + along t), every pivot unknown (paper, section 2: across = L / 2).

    Noise of the seen heading shortens the arm by its variance over that of the turns: 0.1 degrees in turns of 20
    do so by 3e-4 of it, which is left to the camera's own uncertainty.
    """
    normal, right = np.zeros((2, 2)), np.zeros(2)
    for stand in stands:
        across, along = _axes(stand.heading)
        pair = np.stack([across - across.mean(axis=0), along - along.mean(axis=0)], axis=-1)
        centre = stand.pivot * (stand.centre - stand.centre.mean(axis=0))
        normal += np.einsum("nki,nkj->ij", pair, pair)
        right += np.einsum("nki,nk->i", pair, centre)
    across, along = np.linalg.solve(normal, right)
    return _Arm(float(across), float(along))


def _is_switch(before: Stand, after: Stand) -> bool:
    """One followed the other directly, and the camera saw the body at rest in between."""
    adjacent = 0.0 <= after.start - before.end <= LONGEST_SWITCH
    return adjacent and before.pivot != after.pivot and not math.isnan(before.rest)


def _switch(before: Stand, after: Stand, arm: _Arm) -> tuple[float, float, float]:
    """How far the new pivot landed out and forward of its place, m, and the turn about the old one, rad."""
    across, along = (axis[0] for axis in _axes(np.array([before.rest + arm.skew])))
    landed = _pivot_point(after, arm) - (_pivot_point(before, arm) + before.pivot * arm.length * across)
    walking = before.pivot * before.direction
    turn = abs(before.rest - float(before.heading[:2].mean()))
    return float(-after.pivot * landed @ across), float(walking * (landed @ along)), turn


def _pivot_point(stand: Stand, arm: _Arm) -> Array:
    across, along = _axes(stand.heading)
    return (stand.centre - stand.pivot * (arm.across * across + arm.along * along)).mean(axis=0)


def _jackknife(stands: Sequence[Stand]) -> tuple[Array, Array]:
    """Figures of all turns, and standard errors from leaving out a block of neighbours at a time."""
    blocks = min(BLOCKS, len(stands) // 3)
    bounds = np.linspace(0, len(stands), blocks + 1).astype(int)
    partial = [_figures([*stands[:low], *stands[high:]]) for low, high in itertools.pairwise(bounds)]
    return _figures(stands), np.std(partial, axis=0) * math.sqrt(blocks - 1)
