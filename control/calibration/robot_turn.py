"""Turning the robot on the bench, a known angle at a time, and looking at where it comes to rest."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from control.calibration.bench import STRENGTH, Bench
from control.calibration.turning import Station
from control.link.conversion import DriveCommand
from control.model import PIVOT_A, PIVOT_B, TURN, Expectation, Frame, Pivot, Pose, wrap
from control.perception import Tracker
from control.safety import Refused
from control.snapshot import Vector

TILT = math.radians(25.0)
"""Presses an end down surely (paper, section 4)."""
RATE = math.radians(60.0)
"""Slow enough for the camera to follow the ends from frame to frame: a degree each."""
SETTLE = 0.2
"""The robot rests and the picture of it has come this long after the field stands still, s."""
LOOK = 0.1
"""Sightings are averaged over this time, s: six frames."""
UNSEEN = 0.3
"""A robot that has not been seen for so long is not turned any further, s."""
SIGMA = 0.005
"""Where the robot is expected, give or take, m: when the field comes up it may spin about one end."""
RESERVE = 0.9
"""Share of the coils' limits that the turn uses: the robot moves a little while the field stands."""
PROBE = tuple(math.radians(angle) for angle in (10.0, 20.0, 30.0))
"""Turns of the polarity check: more than the play (3 to 7 degrees), and back."""
CIRCLE = 12
"""Headings of a registration, each way."""


@dataclass(slots=True)
class _Sighting:
    pose: Pose
    captured_at: float


class RobotTurn:
    """`tracker` finds the robot; its ends get their names from the rig file's hint when the turn begins."""

    def __init__(self, bench: Bench, tracker: Tracker) -> None:
        self._bench = bench
        self._tracker = tracker
        self._seen: _Sighting | None = None
        self._pivot: Pivot = PIVOT_A
        self._tilt = 0.0
        self._strength = 0.0
        self._field_heading = 0.0
        self._direction = 1

    def put_down(self) -> Pose:
        """The robot's mean pose at rest, without any field; raises `Refused` when it is not seen."""
        self._tracker.reset()
        self._seen = None
        since = self._bench.camera.now()
        poses: list[Pose] = []
        while self._bench.camera.now() - since < UNSEEN + LOOK:
            self._look(self._bench.step(), poses)
        if not poses:
            raise Refused("the robot is not seen; put it in the camera's view")
        return _mean(poses)

    def probe(self) -> list[Station]:
        """The polarity check's stations: a short turn on each pivot, each there and back."""
        start = self._take_up()
        stations = []
        for pivot in (PIVOT_A, PIVOT_B):
            self._stand_on(pivot)
            stations += [self._turn_to(start + angle) for angle in (0.0, *PROBE, *PROBE[-2::-1], 0.0)]
        self._bench.zero()
        return stations

    def circle(self) -> list[Station]:
        """The registration's stations: once round to the left and once back, on pivot A."""
        start = self._take_up()
        angles = [TURN * number / CIRCLE for number in range(1, CIRCLE + 1)]
        stations = [self._turn_to(start + angle) for angle in angles]
        stations += [self._turn_to(start + angle - TURN / CIRCLE) for angle in reversed(angles)]
        self._bench.zero()
        return stations

    def _take_up(self) -> float:
        """Bring the field up along the seen heading; returns that, rad."""
        pose = self._require_seen().pose
        allocation = self._bench.parts.coils.local_allocation(pose.x, pose.y)
        limits = self._bench.parts.limits.currents
        reach = min(limit / math.hypot(*row) for limit, row in zip(limits, allocation, strict=True))
        self._strength = min(STRENGTH, self._bench.settings.max_field, RESERVE * reach)
        self._field_heading, self._pivot, self._tilt = pose.heading, PIVOT_A, TILT
        self._bench.energise(self._drive())
        self._wait(self._strength / self._bench.settings.field_slew + SETTLE)
        return pose.heading

    def _stand_on(self, pivot: Pivot) -> None:
        self._pivot = pivot
        self._wait(SETTLE)

    def _turn_to(self, heading: float) -> Station:
        """Turn the field to `heading` (rad) and look at the robot once it rests."""
        angle = heading - self._field_heading
        self._direction = 1 if angle >= 0.0 else -1
        self._field_heading = heading
        self._wait(abs(angle) / RATE + SETTLE)
        return Station(heading, self._pivot, self._direction, _mean(self._wait(LOOK)))

    def _wait(self, duration: float) -> list[Pose]:
        """Hold the field on its way to its goal for `duration` (s); what was seen meanwhile."""
        until = self._bench.camera.now() + duration
        poses: list[Pose] = []
        while self._bench.camera.now() < until or not poses:
            self._look(self._bench.keep(self._drive()), poses)
            self._require_seen()
        return poses

    def _drive(self) -> DriveCommand:
        pose = self._require_seen().pose
        allocation = self._bench.parts.coils.local_allocation(pose.x, pose.y)
        drive = self._bench.drive(allocation, self._field_heading, self._tilt, self._strength)
        return replace(drive, pivot=self._pivot, rate=self._direction * RATE)

    def _look(self, frame: Frame | None, poses: list[Pose]) -> None:
        if frame is None:
            return
        measurement = self._tracker.update(frame, self._expected()).measurement
        if measurement is not None and measurement.pose.is_finite:
            self._seen = _Sighting(measurement.pose, measurement.captured_at)
            poses.append(measurement.pose)

    def _expected(self) -> Expectation | None:
        if self._seen is None:
            return None
        tilt = self._bench.parts.body_tilt(self._tilt)
        return Expectation(self._seen.pose, SIGMA, self._pivot, tilt)

    def _require_seen(self) -> _Sighting:
        """The newest sighting; at zero and `Refused` when it is old or the robot has left the workspace."""
        seen, now = self._seen, self._bench.camera.now()
        if seen is None or not now - seen.captured_at <= UNSEEN:
            self._bench.zero()
            raise Refused("the robot is not seen any more; put it in the middle of the camera's view")
        reach = max(abs(seen.pose.x), abs(seen.pose.y))
        if not reach <= self._bench.parts.limits.hard:
            self._bench.zero()
            raise Refused(
                f"the robot is {reach * 1e3:.0f} mm out, beyond the workspace; put it in the middle"
            )
        return seen


def _mean(poses: list[Pose]) -> Pose:
    """Mean position and circular mean heading."""
    count = len(poses)
    first = poses[0].heading
    turn = sum(wrap(pose.heading - first) for pose in poses) / count
    mean: Vector = (sum(p.x for p in poses) / count, sum(p.y for p in poses) / count, wrap(first + turn))
    return Pose(*mean)
