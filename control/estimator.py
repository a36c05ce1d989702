"""Where the robot is now: an extended Kalman filter over (x, y, heading) with the pivot kinematics as model.

A measurement is as old as the camera is late. The filter lives at capture times: it is predicted to the
frame's capture time, corrected there, and its mean is carried forward to now through what the field has done
since. The input is the field's motion about the active pivot, less the play that the body is known to have.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from control.backlash import ENGAGED_AFTER, pull_after
from control.field import Field, Turn
from control.gait_model import GaitModel
from control.model import PIVOT_A, PIVOT_B, Expectation, Measurement, Pivot, Pose, body_tilt, swing
from control.pivot_filter import PivotFilter, moved
from control.snapshot import Covariance, Vector

GATE = 16.27
"""99.9 % point of chi-squared with three degrees of freedom."""
SWITCH_DOUBT = 0.005
"""The moment of a pivot switch is known to this, s, as latency and the coils' delay are; a slip that is seen in the
picture before or after the expected one would be refused from then on."""
LIFT_FIELD = 0.010
"""The field at which the lift ratio is given, T: it grows with the field."""


@dataclass(frozen=True, slots=True)
class EstimatorSettings:
    """Standard deviations, m and rad.

    measured: of one sighting.  drift: per root second at rest.  free: the same while no full field holds the robot,
    when rising or decaying currents drag it along, and people push it.
    slip: of the position, per pivot switch.  swing: of the heading, per radian that the field turns once it
    surely pulls the body along.  loose: the same while it may still be taking up the play after a reversal.
    actuation_delay: from a field command to the body's answer, s (serial line and coil currents).
    lift_ratio: 2 m B / (W L) at 10 mT, how far the free end rises (`control.model.body_tilt`).
    gait_model: the mean displacement of a pivot switch, where it has been measured.
    """

    measured_position: float = 0.00004
    measured_heading: float = math.radians(0.35)
    drift_position: float = 0.0002
    drift_heading: float = math.radians(2.0)
    free_position: float = 0.010
    free_heading: float = 1.0
    slip: float = 0.0005
    swing: float = 0.12
    loose: float = 0.6
    actuation_delay: float = 0.001
    lift_ratio: float = 3.2
    gait_model: GaitModel | None = None

    def noise(self, elapsed: float, *, is_held: bool) -> tuple[float, float]:
        """Variances of position, m^2, and heading, rad^2, that a robot at rest gathers in `elapsed` s."""
        if is_held:
            return self.drift_position**2 * elapsed, self.drift_heading**2 * elapsed
        return self.free_position**2 * elapsed, self.free_heading**2 * elapsed


@dataclass(frozen=True, slots=True)
class Carried:
    """The estimate at one instant: pose, and its covariance (m^2, m rad, rad^2)."""

    pose: Pose
    covariance: Covariance

    @property
    def sigma(self) -> Vector:
        """Standard deviations of x, y and heading; m, m, rad."""
        xx, _, _, yy, _, hh = self.covariance
        return math.sqrt(max(xx, 0.0)), math.sqrt(max(yy, 0.0)), math.sqrt(max(hh, 0.0))


@dataclass(frozen=True, slots=True)
class Grip:
    """How the field holds the body, from when it comes up until it goes off: after that nothing is known of it.

    hold: which field it is, by when it was at full strength, s; inf: none.
    slack: where the body lies within the play, rad, within +- half of it.
    pull: how far the field has turned since it last reversed, rad, signed.
    pivot: the end it presses down; None before the first motion.
    turned: how far the body has turned about that end since it took it, rad, signed.
    """

    hold: float = math.inf
    slack: float = 0.0
    pull: float = 0.0
    pivot: Pivot | None = None
    turned: float = 0.0

    @property
    def is_tight(self) -> bool:
        """The play is surely taken up."""
        return abs(self.pull) >= ENGAGED_AFTER

    def after(self, turn: Turn, half_play: float) -> Grip:
        """The grip once the field has made this turn."""
        slack = max(-half_play, min(half_play, self.slack + turn.angle))
        pull = pull_after(self.pull, turn.angle)
        follows = turn.angle + self.slack - slack
        turned = follows + (self.turned if turn.pivot == self.pivot else 0.0)
        return Grip(self.hold, slack, pull, turn.pivot, turned)


class Estimator:
    """Feed it every frame: `expect` before the search, `correct` after it, `carry` for the pose now."""

    def __init__(self, settings: EstimatorSettings, field: Field, length: float) -> None:
        self._settings = settings
        self._field = field
        self._length = length
        self._filter = PivotFilter(
            np.diag([settings.measured_position**2] * 2 + [settings.measured_heading**2])
        )
        self._time = -math.inf
        self._grip = Grip()
        self._known = False
        self.half_play = 0.0
        """Half width of the play between field and body, rad; the loop keeps it up to date."""
        self.last_accepted = -math.inf
        """Capture time of the newest measurement that passed the gate, s."""

    @property
    def known(self) -> bool:
        return self._known

    def forget(self) -> None:
        """The robot is lost: start again at the next sighting."""
        self._known = False

    def start(self, measurement: Measurement) -> None:
        """Believe one sighting entirely."""
        pose = measurement.pose
        self._filter.x = np.array([pose.x, pose.y, pose.heading])
        self._filter.P = 4.0 * self._filter.R
        self._time = self.last_accepted = measurement.captured_at
        self._grip = Grip()
        self._known = True

    def expect(self, time: float) -> Expectation | None:
        """Predict to the capture time of the frame that is about to be searched; None when nothing is known."""
        if not self._known:
            return None
        motion = self._motion(self._time, time)
        pose, self._grip = motion.arrival, motion.grip
        self._filter.move(pose, (motion.dx, motion.dy), motion.noise)
        self._time = time
        at = time - self._settings.actuation_delay
        elevation = self._field.elevation_at(at)
        lift_ratio = self._settings.lift_ratio * self._field.strength_at(at) / LIFT_FIELD
        return Expectation(
            pose,
            position_sigma=self.position_sigma,
            pivot=PIVOT_B if elevation > 0.0 else PIVOT_A,
            tilt=body_tilt(abs(elevation), lift_ratio),
            heading_sigma=self._filter.heading_sigma,
        )

    def correct(self, measurement: Measurement) -> bool:
        """Fuse a sighting made at the time of the last `expect`; False when the gate refuses it."""
        pose = measurement.pose
        if not pose.is_finite or not self._filter.innovate((pose.x, pose.y, pose.heading)) <= GATE:
            return False
        self._filter.fuse()
        self.last_accepted = measurement.captured_at
        return True

    def distance(self, z: NDArray[np.float64]) -> float:
        """Squared Mahalanobis distance of a sighting (x, y, heading) from the prediction."""
        return self._filter.innovate(z.tolist())

    @property
    def grip(self) -> Grip:
        """How the field holds the body at the filter's own time."""
        return self._grip

    def carry(self, time: float) -> Carried:
        """The estimate carried forward to `time` (s) through what the field has done since."""
        motion = self._motion(self._time, time)
        covariance = moved(self._filter.covariance, (motion.dx, motion.dy), motion.noise)
        return Carried(motion.arrival, covariance)

    @property
    def position_sigma(self) -> float:
        """Standard deviation of the position at the filter's own time, along the worse axis, m."""
        return self._filter.position_sigma

    @property
    def covariance(self) -> NDArray[np.float64]:
        """(3, 3) covariance of (x, y, heading) at the filter's own time, m^2, m rad, rad^2."""
        return self._filter.P

    def _motion(self, start: float, end: float) -> Motion:
        """The body's motion from `start` to `end` (s), as the field has led it."""
        settings, grip = self._settings, self._grip
        if grip.hold != self._field.full_at:
            grip = Grip(self._field.full_at)  # it comes up along the body's heading, amid the play
        delay, elapsed = settings.actuation_delay, max(end - start, 0.0)
        departure = arrival = Pose(*self._filter.mean)
        position, heading = settings.noise(elapsed, is_held=self._field.is_ready)
        noise = position, 0.0, 0.0, position, 0.0, heading
        switches = 0
        for turn in self._field.turns(start - delay, end - delay):
            held = grip.after(turn, self.half_play)
            if grip.pivot not in (None, turn.pivot):
                arrival = self._landed(arrival, grip)
                switches += 1
            arrival = swing(arrival, turn.pivot, turn.angle + grip.slack - held.slack, self._length)
            doubt = (settings.swing if held.is_tight else settings.loose) * turn.angle
            noise = swung(noise, doubt, arrival.heading, 0.5 * self._length * turn.pivot)
            grip = held
        slip = (switches or self._may_switch(start - delay, end - delay)) * settings.slip**2
        xx, xy, xh, yy, yh, hh = noise
        noise = xx + slip, xy, xh, yy + slip, yh, hh
        return Motion(arrival, grip, arrival.x - departure.x, arrival.y - departure.y, noise)

    def _may_switch(self, start: float, end: float) -> bool:
        """Whether the robot may have taken its other end between two instants, s."""
        before, after = start - SWITCH_DOUBT, end + SWITCH_DOUBT
        return self._field.pivot_at(before) != self._field.pivot_at(after)

    def _landed(self, pose: Pose, grip: Grip) -> Pose:
        """What the switch away from the grip's pivot does on average, where that has been measured."""
        model = self._settings.gait_model
        return pose if model is None or grip.pivot is None else model.landed(pose, grip.pivot, grip.turned)


def swung(noise: Covariance, doubt: float, heading: float, arm: float) -> Covariance:
    """The noise of a motion that ends with a swing to `heading`, rad, known to within `doubt` (rad, one sigma).

    A body that turns less or more than expected does so about its pivot, so its centre stays back or goes on along
    the arc. arm: from the pivot to the centre, m, signed.
    """
    xx, xy, xh, yy, yh, hh = noise
    x, y = arm * math.cos(heading), arm * math.sin(heading)
    q = doubt * doubt
    return xx + q * x * x, xy + q * x * y, xh + q * x, yy + q * y * y, yh + q * y, hh + q


@dataclass(frozen=True, slots=True)
class Motion:
    """One piece of the body's motion: where it leads (dx, dy: displacement, m), and the covariance of its noise."""

    arrival: Pose
    grip: Grip
    dx: float
    dy: float
    noise: Covariance
