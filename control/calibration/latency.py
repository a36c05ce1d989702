"""How late the camera is: from a robot that is turned to and fro to the time between field and picture. Pure.

The body's heading is the field's behind a play p (the play operator P), so a sighting that bears the time t
shows o + g P(F)(t - d): F the field's heading, d the delay that is sought, o what the frames of camera and
coils are turned against each other, g near 1 how far the body follows. Least squares over all sightings for
(d, p, g, o). What would shift the answer drops out: a play, since it is in angle and not in time (there are
two rates, and rests); an offset, since the turns go both ways.
"""

from __future__ import annotations

import math
from copy import copy
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from control.calibration.turning import FOLLOWS, Unclear
from control.model import TURN, Pose

Floats = NDArray[np.float64]

LONGEST = 0.200
"""A camera that is later than this is too late to walk with, s (`control.arbiter.FRAME_TOO_LATE` and a reserve)."""
EARLIEST = -0.050
"""The search begins before zero, s, so that a delay of nothing is found and not cut off."""
FEWEST_SIGHTINGS = 100
"""While the field turns: 2 s of a camera with 60 frames a second."""
WORST_RESIDUAL = math.radians(1.5)
"""Headings may scatter by this about the fit, rad: the camera's share is 0.35 degrees, the play's own scatter 1."""
WORST_ERROR = 0.002
"""A delay that is known no better than this, s, is not worth a place in the rig file: at 100 degrees a second
it is 0.2 degrees, half of the noise of one sighting."""
PLAY_AT_MOST = math.radians(15.0)
BLOCKS = 12
"""Stretches of time whose errors are taken as independent; neighbouring sightings share theirs."""
FAR_OFF = 6.0
"""A sighting further off than so many times the usual is false: of good ones, one in 20 000 is (4 sigma)."""
LEAST_SCATTER = math.radians(0.02)
"""Less than this, rad, is no scatter of a camera."""
MOST_FALSE = 0.1
"""Share of the sightings that may be left out as false."""
SMALLEST_BEND = 1e-3
"""A field whose rate changes by less than this, rad/s, goes straight on."""
TRIED = np.arange(0.0, LONGEST, 0.010)
"""Delays at which the fit is begun, s: steps as short as the shortest turn's slope is wide."""


@dataclass(frozen=True, slots=True)
class Wiggled:
    """A robot that was turned to and fro, with the field.

    field_times, field_headings: (n,) s and rad, unwrapped, straight in between.
    times, headings: (m,) s, as the camera's stamps say, and the body's as seen, rad.
    """

    field_times: Floats
    field_headings: Floats
    times: Floats
    headings: Floats


@dataclass(frozen=True, slots=True)
class Delay:
    """delay, standard_error: s.  play, residual (rms): rad.  gain: turn of the body over that of the field.

    sightings: how many the answer comes from.
    """

    delay: float
    standard_error: float
    play: float
    gain: float
    residual: float
    sightings: int


class WiggleRecord:
    """Gathers what `delay_of` wants while the robot is turned."""

    def __init__(self) -> None:
        self._field: list[tuple[float, float]] = []
        self._seen: list[tuple[float, float]] = []

    @property
    def field_known_until(self) -> float:
        """Time of the newest heading of the field, s; minus infinity before the first."""
        return self._field[-1][0] if self._field else -math.inf

    @property
    def seen_until(self) -> float:
        """Stamp of the newest sighting, s; minus infinity before the first."""
        return self._seen[-1][0] if self._seen else -math.inf

    def field(self, time: float, heading: float) -> None:
        """The field's heading (rad, unwrapped) at a later time (s) than the one before."""
        self._field.append((time, heading))

    def sighting(self, time: float, pose: Pose) -> None:
        """The robot as seen in a picture that bears the stamp `time`, s."""
        self._seen.append((time, pose.heading))

    @property
    def wiggled(self) -> Wiggled:
        field, seen = np.array(self._field).reshape(-1, 2), np.array(self._seen).reshape(-1, 2)
        return Wiggled(field[:, 0], field[:, 1], seen[:, 0], seen[:, 1])


def delay_of(wiggled: Wiggled) -> Delay:
    """By how much the camera's stamps are later than the field that they show; raises `Unclear`."""
    fit, found = _without_false(_Fit(_covered(wiggled)))
    delay, play, gain, _ = found.tolist()
    residual = math.sqrt(float(np.mean(fit.misses(found) ** 2)))
    answer = Delay(delay, fit.standard_error(found), play, gain, residual, fit.sightings)
    _require_clear(answer)
    return answer


def _without_false(fit: _Fit) -> tuple[_Fit, Floats]:
    """The fit without the few sightings that are far off what all others say, and its parameters."""
    found = fit.solve(_tried(fit))
    misses = np.abs(fit.misses(found))
    good = misses <= FAR_OFF * max(float(np.median(misses)), LEAST_SCATTER)
    if good.all() or not good.mean() >= 1.0 - MOST_FALSE:
        return fit, found
    fit = fit.only(good)
    return fit, fit.solve(found)


def _tried(fit: _Fit) -> Floats:
    """Parameters at the best of the delays tried."""
    return min((fit.start(delay) for delay in TRIED), key=lambda start: start[1])[0]


def _covered(wiggled: Wiggled) -> Wiggled:
    """Only the sightings for which the field is known over the whole range of delays; raises `Unclear`."""
    times, field = wiggled.times, wiggled.field_times
    if len(field) < 2 or len(times) == 0:
        raise Unclear("the robot was not seen while the field turned; put it in the camera's view")
    kept = (times >= field[0] + LONGEST) & (times <= field[-1] + EARLIEST)
    turning = np.abs(np.gradient(wiggled.field_headings, field)) > 0.0
    if not np.interp(times[kept], field, turning).sum() >= FEWEST_SIGHTINGS:
        raise Unclear(
            f"the robot was seen {int(kept.sum())} times, {FEWEST_SIGHTINGS} sightings while the field turns are "
            "needed; make more turns, or use a camera that gives more pictures a second"
        )
    return Wiggled(field, wiggled.field_headings, times[kept], wiggled.headings[kept])


class _Fit:
    """The model and its misses; parameters are (delay, play, gain, offset): s, rad, 1, rad."""

    def __init__(self, wiggled: Wiggled) -> None:
        self._field_times, self._field = corners_of(wiggled.field_times, wiggled.field_headings)
        self._times = wiggled.times
        there = np.interp(self._times, self._field_times, self._field)
        apart = wiggled.headings - there
        middle = math.atan2(float(np.sin(apart).mean()), float(np.cos(apart).mean()))
        self._middle = float(self._field.mean())
        self._seen = there - self._middle + middle + (apart - middle + math.pi) % TURN - math.pi

    @property
    def sightings(self) -> int:
        return len(self._times)

    def only(self, kept: NDArray[np.bool_]) -> _Fit:
        """The same with some of its sightings."""
        part = copy(self)
        part._times, part._seen = self._times[kept], self._seen[kept]
        return part

    def solve(self, begin: Floats) -> Floats:
        """Least squares, in which a sighting far off counts less."""
        found = least_squares(
            self.misses,
            begin,
            bounds=([EARLIEST, 0.0, -2.0, -np.inf], [LONGEST, PLAY_AT_MOST, 2.0, np.inf]),
            x_scale=[1e-3, 1e-2, 0.1, 1e-2],
            loss="soft_l1",
            f_scale=WORST_RESIDUAL,
            xtol=1e-6,
        )
        return np.asarray(found.x, dtype=np.float64)

    def start(self, delay: float) -> tuple[Floats, float]:
        """Gain and offset that suit a delay without any play, and the squares that are left."""
        field = np.interp(self._times - delay, self._field_times, self._field) - self._middle
        design = np.column_stack([field, np.ones_like(field)])
        (gain, offset), *_ = np.linalg.lstsq(design, self._seen, rcond=None)
        misses = self._seen - design @ np.array([gain, offset])
        return np.array([delay, 0.0, np.clip(gain, -1.9, 1.9), offset]), float(misses @ misses)

    def misses(self, parameters: Floats) -> Floats:
        """(m,) rad."""
        delay, play, gain, offset = parameters
        body_times, body = behind_play(self._field_times, self._field, float(play))
        follows = gain * (np.interp(self._times - delay, body_times, body) - self._middle)
        return self._seen - follows - offset

    def standard_error(self, found: Floats) -> float:
        """Of the delay, s, with errors that are alike within a block of time (the sandwich estimate)."""
        slopes = np.column_stack([self._slope(found, index) for index in range(len(found))])
        bread = np.linalg.pinv(slopes.T @ slopes)
        pulls = slopes * self.misses(found)[:, None]
        blocks = np.array([block.sum(axis=0) for block in np.array_split(pulls, BLOCKS)])
        spread = bread @ (blocks.T @ blocks) @ bread * BLOCKS / (BLOCKS - len(found))
        return math.sqrt(float(spread[0, 0]))

    def _slope(self, found: Floats, index: int) -> Floats:
        step = np.zeros_like(found)
        step[index] = 1e-3
        return (self.misses(found) - self.misses(found + step)) / step[index]


def behind_play(times: Floats, field: Floats, play: float) -> tuple[Floats, Floats]:
    """Corner points (s, rad) of a body that follows the field's behind a play (rad): the play operator.

    It begins in the middle of its play. Where a stretch of the field takes the play up, the body has a corner
    of its own.
    """
    half, held, before = 0.5 * play, float(field[0]), float(field[0])
    corners = [(float(times[0]), held)]
    for start, end, heading in zip(times[:-1].tolist(), times[1:].tolist(), field[1:].tolist(), strict=True):
        pulled = min(max(held, heading - half), heading + half)
        if pulled != held:
            taken_up = held + math.copysign(half, pulled - held)
            corners.append((start + (end - start) * (taken_up - before) / (heading - before), held))
        corners.append((end, pulled))
        held, before = pulled, heading
    body = np.array(corners)
    return body[:, 0], body[:, 1]


def corners_of(times: Floats, headings: Floats) -> tuple[Floats, Floats]:
    """Only the points (s, rad) at which a line through all of them bends, and its ends."""
    slopes = np.diff(headings) / np.diff(times)
    bends = np.abs(np.diff(slopes)) > SMALLEST_BEND
    kept = np.concatenate([[True], bends, [True]])
    return times[kept], headings[kept]


def _require_clear(found: Delay) -> None:
    if not FOLLOWS[0] <= found.gain <= FOLLOWS[1]:
        raise Unclear(
            f"the robot turns {found.gain:+.1f} times as far as the field: it does not follow; check that it is free, "
            "and that the coils are wired right (`pivotrig calibrate polarity`)"
        )
    if not found.residual <= WORST_RESIDUAL:
        raise Unclear(
            f"the seen headings are {math.degrees(found.residual):.1f} degrees off what a late camera would see, "
            f"allowed are {math.degrees(WORST_RESIDUAL):g}: the robot sticks, or is seen badly"
        )
    if not found.standard_error <= WORST_ERROR:
        raise Unclear(
            f"the delay is uncertain by {found.standard_error * 1e3:.1f} ms, allowed are {WORST_ERROR * 1e3:g}: "
            "make more turns, or faster ones"
        )
    if not found.delay < LONGEST - 3.0 * WORST_ERROR:
        raise Unclear(
            f"the camera is {LONGEST * 1e3:.0f} ms late or more, which is too late to walk with: use a shorter "
            "exposure, a smaller picture, or another camera"
        )
