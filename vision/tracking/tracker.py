"""Follows the robot from frame to frame: where to look, which blob it is, and its pose in the workspace."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field

from control.model import (
    PIVOT_A,
    Expectation,
    Frame,
    Measurement,
    Observation,
    Pivot,
    Pose,
    Tracking,
    wrap,
)
from vision.camera_model import CameraModel
from vision.tracking.colour import ColourRange, Image
from vision.tracking.detection import Blob, Candidate, RegionFilter, Window, find, measure

RED = ColourRange(hue=(340, 20), saturation=(110, 255), value=(60, 255))
"""The shipped robot's colour: red in any light that leaves it a third of full brightness."""
WINDOW_SIGMAS = 4.0
"""The window holds the robot when its place is that many standard deviations off: 1 in 3 000 is missed."""
MISSES_BEFORE_WIDE_SEARCH = 3
"""After as many windows without the robot the whole frame is searched."""
COARSE_WIDTH = 2.5
"""The whole frame is searched on the coarsest grid that leaves the body this wide, in grid points."""
COARSE_AREA_TOLERANCE = 2.0
"""On that grid an area may be wrong by this factor."""
LARGEST_TILT = math.radians(60.0)
"""An expected tilt beyond this is none that the rig can command; the robot is then taken as flat."""
TRIES = 4
"""So many candidates of a coarse search are looked at closely, best first."""


@dataclass(frozen=True, slots=True)
class TrackerSettings:
    """What the robot looks like and how patient the tracker is.

    colour: thresholds.  region: area of the body seen from above, m^2.
    elongation_min: long over short radius of gyration; a rounder blob has no axis to speak of.
    margin: how far beyond the expected uncertainty the robot may be, m.
    heading_hint: which of two opposite headings to take when nothing else tells, rad.
    predict_for: how long after the last sighting the robot counts as predicted, s (faults.md: 150 ms).
    """

    colour: ColourRange = field(default=RED)
    region: RegionFilter = field(default=RegionFilter(12e-6, 90e-6))
    elongation_min: float = 1.4
    margin: float = 0.003
    heading_hint: float = 0.5 * math.pi
    predict_for: float = 0.150


@dataclass(frozen=True, slots=True)
class Search:
    """Where to look (window, px) and how far from a place (u, v; px) a blob may be (inf: anywhere)."""

    window: Window
    centre: tuple[float, float]
    reach: float


@dataclass(frozen=True, slots=True)
class Attitude:
    """How the robot is expected to stand: heading (rad), pressed end, elevation of the other end (rad)."""

    heading: float
    pivot: Pivot
    tilt: float


class ColourTracker:
    """Finds one robot of one colour. Satisfies the loop's tracker protocol; no clock of its own.

    robot_length: length of the body, m.  body_height: of its top surface above the plate, m.
    """

    def __init__(
        self, camera_model: CameraModel, settings: TrackerSettings, robot_length: float, body_height: float
    ) -> None:
        self._camera = camera_model
        self._settings = settings
        self._length = robot_length
        self._height = body_height
        self._scale = camera_model.scale_at(0.0, 0.0, body_height)
        self._region = settings.region.scaled(self._scale**2)
        self._whole: Window = (0, 0, *camera_model.size)
        self._decimation = self._coarsest()
        self.reset()

    def reset(self) -> None:
        """Forgets the robot, and with it which end is A."""
        self._seen_at: float | None = None
        self._heading = self._settings.heading_hint
        self._misses = 0

    def mask(self, image: Image) -> Image:
        """255 where the picture has the robot's colour, for people to look at."""
        return self._settings.colour.mask(image)

    def update(self, frame: Frame, expected: Expectation | None) -> Observation:
        """What this frame tells: a measurement, or for how long there has been none.

        A frame of another size than the calibration's is not looked at.
        """
        search = self._search(expected)
        blob = None
        if frame.image.shape == (self._whole[3], self._whole[2], 3):
            blob = self._look(frame.image, search)
        if blob is None:
            self._misses += 1
            return Observation(self._without(frame.captured_at), None, search.window)
        measurement = self._measurement(blob, frame.captured_at, self._attitude(expected))
        self._misses, self._seen_at, self._heading = 0, frame.captured_at, measurement.pose.heading
        return Observation(Tracking.LOCKED, measurement, search.window)

    def _without(self, captured_at: float) -> Tracking:
        age = math.inf if self._seen_at is None else captured_at - self._seen_at
        return Tracking.PREDICTED if 0.0 <= age <= self._settings.predict_for else Tracking.LOST

    def _search(self, expected: Expectation | None) -> Search:
        if expected is None or not (expected.pose.is_finite and math.isfinite(expected.position_sigma)):
            return Search(self._whole, (0.0, 0.0), math.inf)
        centre = self._camera.to_pixel(expected.pose.x, expected.pose.y, self._height)
        reach = (WINDOW_SIGMAS * expected.position_sigma + self._settings.margin) * self._scale
        return Search(self._around(centre, reach), centre, reach)

    def _look(self, image: Image, search: Search) -> Blob | None:
        if math.isinf(search.reach):
            return self._anywhere(image, search)
        blob = self._within(image, search)
        if blob is None and self._misses >= MISSES_BEFORE_WIDE_SEARCH:
            # A robot that was pushed turns up next to its place; a far blob waits until nothing is expected.
            wider = search.reach + self._length * self._scale
            return self._anywhere(image, Search(self._whole, search.centre, wider))
        return blob

    def _within(self, image: Image, search: Search) -> Blob | None:
        """The best blob of the window at full resolution."""
        candidates = find(image, search.window, self._settings.colour, self._region)
        for candidate in self._ranked(candidates, search)[:TRIES]:
            if not _touches(candidate.box, search.window):
                blob = measure(image, search.window, candidate)
            elif _touches(candidate.box, self._whole):
                continue
            else:
                blob = self._closely(image, candidate)
            if blob is not None and blob.elongation >= self._settings.elongation_min:
                return blob
        return None

    def _closely(self, image: Image, candidate: Candidate) -> Blob | None:
        """The blob at a candidate's place that a window cut or a coarse grid saw roughly."""
        search = Search(self._around(candidate.centre, 0.5 * self._reach), candidate.centre, self._reach)
        found = find(image, search.window, self._settings.colour, self._region)
        whole = [each for each in self._ranked(found, search) if not _touches(each.box, search.window)]
        return measure(image, search.window, whole[0]) if whole else None

    def _anywhere(self, image: Image, search: Search) -> Blob | None:
        """The best blob of the whole frame: found on a coarse grid, then looked at closely."""
        coarse = self._region.scaled(1.0, COARSE_AREA_TOLERANCE)
        found = find(image, self._whole, self._settings.colour, coarse, self._decimation)
        for candidate in self._ranked(found, search)[:TRIES]:
            blob = self._closely(image, candidate)
            if blob is not None and blob.elongation >= self._settings.elongation_min:
                return blob
        return None

    def _ranked(self, candidates: Iterable[Candidate], search: Search) -> list[Candidate]:
        """Those within reach, best first: near the expected place and of the right size."""
        typical = self._region.middle
        costs = []
        for candidate in candidates:
            (u, v), (centre_u, centre_v) = candidate.centre, search.centre
            distance = math.hypot(u - centre_u, v - centre_v)
            if distance <= search.reach:
                costs.append((distance / search.reach + abs(math.log(candidate.area / typical)), candidate))
        return [candidate for _, candidate in sorted(costs, key=lambda pair: pair[0])]

    @property
    def _reach(self) -> float:
        """Half a body length, px."""
        return 0.5 * self._length * self._scale

    def _around(self, centre: tuple[float, float], reach: float) -> Window:
        """The window that holds the whole body when its centre is within `reach` px of a place, px."""
        half = min(reach + 0.6 * self._length * self._scale + 2.0, float(max(self._whole)))
        width, height = self._whole[2:]
        u, v = (
            min(max(place, -half), limit + half) for place, limit in zip(centre, (width, height), strict=True)
        )
        left, right = max(math.floor(u - half), 0), min(math.ceil(u + half), width)
        top, bottom = max(math.floor(v - half), 0), min(math.ceil(v + half), height)
        return min(left, width - 1), min(top, height - 1), max(right, left + 1, 1), max(bottom, top + 1, 1)

    def _coarsest(self) -> int:
        width = self._region.middle / (self._length * self._scale)
        return next((step for step in (8, 4, 2) if width / step >= COARSE_WIDTH), 1)

    def _attitude(self, expected: Expectation | None) -> Attitude:
        if expected is None or not expected.pose.is_finite:
            return Attitude(self._heading, PIVOT_A, 0.0)
        tilt = expected.tilt if 0.0 <= expected.tilt <= LARGEST_TILT else 0.0
        return Attitude(expected.pose.heading, expected.pivot, tilt)

    def _measurement(self, blob: Blob, captured_at: float, attitude: Attitude) -> Measurement:
        """The pose of the flat robot.

        The pressed end stays when it tilts; the other end rises and comes nearer to the camera. So the two
        halves of the long axis are mapped at the height of their own end, and the flat robot's centre lies
        L/2 (1 - cos(tilt)) further from the pressed end than the blob's does.
        """
        (u, v), half, side = blob.centre, self._reach, self._side(blob, attitude.heading)
        lift = self._length * math.sin(attitude.tilt)
        height_a, height_b = (0.0, lift) if attitude.pivot == PIVOT_A else (lift, 0.0)
        du, dv = side * half * math.cos(blob.axis), side * half * math.sin(blob.axis)
        x, y = self._camera.to_point(u, v, self._height + 0.5 * lift)
        ax, ay = self._camera.to_point(u + du, v + dv, self._height + height_a)
        bx, by = self._camera.to_point(u - du, v - dv, self._height + height_b)
        heading = wrap(math.atan2(ay - by, ax - bx) - 0.5 * math.pi)
        shift = -0.5 * attitude.pivot * self._length * (1.0 - math.cos(attitude.tilt))
        pose = Pose(x - shift * math.sin(heading), y + shift * math.cos(heading), heading)
        return Measurement(pose, captured_at, blob.centre, blob.corners, blob.area)

    def _side(self, blob: Blob, heading: float) -> int:
        """+1 when the blob's axis points from B to A for the expected heading, -1 when the other way."""
        (u, v), half = blob.centre, self._reach
        du, dv = half * math.cos(blob.axis), half * math.sin(blob.axis)
        x, y = self._camera.to_point(u, v, self._height)
        ahead_x, ahead_y = self._camera.to_point(u + du, v + dv, self._height)
        return 1 if (ahead_y - y) * math.cos(heading) - (ahead_x - x) * math.sin(heading) >= 0.0 else -1


def _touches(box: Window, window: Window) -> bool:
    """Whether a box reaches the window's edge, so that the window may have cut the blob."""
    return box[0] <= window[0] or box[1] <= window[1] or box[2] >= window[2] or box[3] >= window[3]
