"""The filter: consistent, symmetric, and right about now although the camera is late."""

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from control.estimator import GATE, Carried, Estimator, EstimatorSettings
from control.field_model import FieldModel
from control.model import PIVOT_A, PIVOT_B, Measurement, Pivot, Pose, swing

LENGTH = 0.010
PERIOD = 1 / 60
LATENCY = 0.035
SETTINGS = EstimatorSettings()


def sighting(pose: Pose, time: float) -> Measurement:
    return Measurement(pose, time, (0.0, 0.0), (), 500.0)


class Stroll:
    """A robot that obeys a walking field, seen by a noisy camera that delivers late."""

    def __init__(self, seed: int, noise: bool = True) -> None:
        self.random = np.random.default_rng(seed)
        self.field = FieldModel(0.05, 0.1)
        self.field.start(0.0, 0.4, PIVOT_A, 0.4, 0.001)
        self.field.advance(0.05)
        self.estimator = Estimator(SETTINGS, self.field, LENGTH)
        self.noise = noise
        self.truth = {0.05: Pose(0.0, 0.0, 0.4)}
        self.now = 0.05

    def step(self) -> None:
        """One frame period; the field swings to and fro, changing pivots."""
        phase = int(self.now / 0.5) % 2
        pivot: Pivot = PIVOT_A if phase == 0 else PIVOT_B
        self.field.command(pivot, 0.4, 1.2 * pivot, 0.4 + 0.25 * pivot)
        before, self.now = self.now, self.now + PERIOD
        self.field.advance(self.now)
        pose = self.truth[before]
        delay = SETTINGS.actuation_delay
        for turn in self.field.turns(before - delay, self.now - delay):
            pose = swing(pose, turn.pivot, turn.angle, LENGTH)
        self.truth[self.now] = pose

    def see(self, time: float) -> Measurement:
        """The robot at one of the past instants."""
        pose = self.truth[time]
        if not self.noise:
            return sighting(pose, time)
        dx, dy = self.random.normal(0.0, SETTINGS.measured_position, 2)
        return sighting(
            Pose(pose.x + dx, pose.y + dy, pose.heading + self.random.normal(0.0, SETTINGS.measured_heading)),
            time,
        )

    def look(self, frames_late: int = 2) -> tuple[NDArray[np.float64], float]:
        """Filter the frame of two periods ago; the innovation's squared distance comes with the error."""
        captured = list(self.truth)[-1 - frames_late]
        measurement = self.see(captured)
        if not self.estimator.known:
            self.estimator.start(measurement)
            return np.zeros(3), 0.0
        self.estimator.expect(captured)
        pose = measurement.pose
        distance = self.estimator.distance(np.array([pose.x, pose.y, pose.heading]))
        assert self.estimator.correct(measurement) == (distance <= GATE)
        now, true = self.estimator.carry(self.now).pose, self.truth[self.now]
        return np.array([now.x - true.x, now.y - true.y, now.heading - true.heading]), distance


def test_without_noise_the_late_camera_makes_no_error_at_all() -> None:
    stroll = Stroll(0, noise=False)
    for _ in range(3):
        stroll.step()
    for _ in range(200):
        stroll.step()
        error, _ = stroll.look()
        assert np.abs(error) == pytest.approx(np.zeros(3), abs=1e-12)


def test_the_covariance_stays_symmetric_and_positive() -> None:
    stroll = Stroll(1)
    for index in range(600):
        stroll.step()
        if index > 3:
            stroll.look()
            covariance = stroll.estimator.covariance
            assert covariance == pytest.approx(covariance.T, abs=1e-15)
            assert np.linalg.eigvalsh(covariance).min() > 0.0


def test_the_innovations_are_no_larger_than_chi_squared_with_three_degrees_of_freedom() -> None:
    stroll = Stroll(2)
    distances = []
    for index in range(3000):
        stroll.step()
        if index > 3:
            distances.append(stroll.look()[1])
    # The motion is perfect here while the filter allows for slip, so it must be cautious: mean below 3.
    assert 1.5 < float(np.mean(distances)) < 3.2
    assert max(distances) <= GATE


def test_the_estimate_is_better_than_the_sighting() -> None:
    stroll = Stroll(3)
    errors = []
    for index in range(1500):
        stroll.step()
        if index > 20:
            errors.append(stroll.look()[0])
    rms = np.sqrt((np.array(errors) ** 2).mean(axis=0))
    assert rms[0] < SETTINGS.measured_position
    assert rms[2] < SETTINGS.measured_heading


def test_a_far_sighting_is_refused_and_changes_nothing() -> None:
    stroll = Stroll(4)
    for index in range(30):
        stroll.step()
        if index > 3:
            stroll.look()
    captured = list(stroll.truth)[-2]
    stroll.estimator.expect(captured)
    before = stroll.estimator.carry(stroll.now).pose
    true = stroll.truth[captured]
    assert not stroll.estimator.correct(sighting(Pose(true.x + 0.02, true.y, true.heading), captured))
    assert stroll.estimator.carry(stroll.now).pose == before


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_a_sighting_that_is_not_finite_is_refused(bad: float) -> None:
    stroll = Stroll(5)
    for index in range(10):
        stroll.step()
        if index > 3:
            stroll.look()
    captured = list(stroll.truth)[-2]
    stroll.estimator.expect(captured)
    assert not stroll.estimator.correct(sighting(Pose(bad, 0.0, 0.0), captured))


def test_the_heading_residual_wraps() -> None:
    field = FieldModel(0.05, 0.1)
    estimator = Estimator(SETTINGS, field, LENGTH)
    estimator.start(sighting(Pose(0.0, 0.0, math.pi - 0.001), 0.0))
    estimator.expect(0.016)
    assert estimator.correct(sighting(Pose(0.0, 0.0, -math.pi + 0.001), 0.016))
    assert estimator.carry(0.016).pose.heading == pytest.approx(math.pi, abs=0.002)


def test_play_delays_the_body_by_its_width_after_a_reversal() -> None:
    field = FieldModel(0.05, 0.1)
    field.start(0.0, 0.0, PIVOT_A, 0.4, 0.001)
    field.advance(0.1)
    estimator = Estimator(SETTINGS, field, LENGTH)
    estimator.start(sighting(Pose(0.0, 0.0, 0.0), 0.1))
    estimator.half_play = 0.02
    field.command(PIVOT_A, 0.4, 1.0, 0.2)
    field.advance(0.5)
    estimator.expect(0.4)
    assert estimator.carry(0.5).pose.heading == pytest.approx(0.2 - 0.02)
    field.command(PIVOT_A, 0.4, -1.0, 0.0)
    field.advance(1.0)
    assert estimator.carry(1.0).pose.heading == pytest.approx(0.02)


def test_what_is_known_of_the_grip_ends_when_the_field_goes_off() -> None:
    field = FieldModel(0.05, 0.1)
    field.start(0.0, 0.0, PIVOT_A, 0.4, 0.001)
    field.advance(0.1)
    estimator = Estimator(SETTINGS, field, LENGTH)
    estimator.start(sighting(Pose(0.0, 0.0, 0.0), 0.1))
    estimator.half_play = 0.02
    field.command(PIVOT_A, 0.4, 1.0, 0.3)
    field.advance(0.5)
    estimator.expect(0.5)
    assert estimator.grip.is_tight
    field.stop(0.5)
    field.advance(0.6)
    estimator.expect(0.6)
    assert not estimator.grip.is_tight
    field.start(0.6, 0.28, PIVOT_B, 0.4, 0.001)
    field.advance(0.7)
    field.command(PIVOT_B, 0.4, 1.0, 0.5)
    estimator.expect(0.7)
    there = estimator.carry(0.7).pose.heading
    field.advance(0.71)
    estimator.expect(0.71)
    assert not estimator.grip.is_tight
    assert estimator.carry(0.71).pose.heading == there, "the field first takes up the play again"


@pytest.mark.parametrize("rate", [1.2, 2.0, -2.0])
@pytest.mark.parametrize("pivot", [PIVOT_A, PIVOT_B])
def test_a_body_that_stays_in_a_play_that_nobody_has_measured_is_believed(rate: float, pivot: Pivot) -> None:
    """A body that turns less than its field has not come as far along its arc either."""
    play = math.radians(4.0)
    field = FieldModel(0.05, 0.1)
    field.start(0.0, 0.3, pivot, 0.4, 0.001)
    field.advance(0.1)
    estimator = Estimator(SETTINGS, field, LENGTH)
    body = Pose(0.0, 0.0, 0.3)
    estimator.start(sighting(body, 0.1))
    for frame in range(1, 10):
        field.advance(0.1 + frame * PERIOD)
        estimator.expect(0.1 + frame * PERIOD)
        assert estimator.correct(sighting(body, 0.1 + frame * PERIOD))
    now = 0.1 + 9 * PERIOD
    field.command(pivot, 0.4, rate, 0.3 + math.copysign(0.5, rate))
    for _ in range(20):
        now += PERIOD
        field.advance(now)
        lead = field.heading_at(now - SETTINGS.actuation_delay) - body.heading
        body = swing(body, pivot, math.copysign(max(0.0, abs(lead) - play), rate), LENGTH)
        estimator.expect(now)
        assert estimator.correct(sighting(body, now)), f"{math.degrees(lead):.1f} degrees ahead"


@pytest.mark.parametrize("cut", [0.0, 0.010, 0.0249, 0.025, 0.0251, 0.040, 0.060])
def test_a_pivot_switch_is_allowed_its_slip_wherever_the_frames_fall(cut: float) -> None:
    field = FieldModel(0.05, 0.1)
    field.start(0.0, 0.0, PIVOT_A, 0.4, 0.001)
    field.advance(0.1)
    estimator = Estimator(SETTINGS, field, LENGTH)
    estimator.start(sighting(Pose(0.0, 0.0, 0.0), 0.1))
    estimator.expect(0.11)
    field.command(PIVOT_B, 0.4, 0.0, 0.0)
    field.advance(0.3)
    estimator.expect(0.11 + cut)
    estimator.expect(0.25)
    assert estimator.covariance[0, 0] > SETTINGS.slip**2


@pytest.mark.parametrize("late", [-0.004, 0.0, 0.004])
@pytest.mark.parametrize("phase", [0.0, 0.004, 0.008, 0.012, 0.016])
def test_a_slip_is_believed_although_the_moment_of_the_switch_is_not_known_to_the_millisecond(
    phase: float, late: float
) -> None:
    """Pictures before the slip must not make the filter so sure that it refuses all pictures after it."""
    field = FieldModel(0.05, 0.1)
    field.start(0.0, 0.0, PIVOT_A, 0.4, 0.001)
    field.advance(0.1)
    field.command(PIVOT_B, 0.4, 0.0, 0.0)
    field.advance(0.4)
    estimator = Estimator(SETTINGS, field, LENGTH)
    estimator.start(sighting(Pose(0.0, 0.0, 0.0), 0.05))
    slip_at = 0.1 + 0.025 + SETTINGS.actuation_delay + late
    for frame in range(10):
        time = 0.06 + phase + frame / 60
        estimator.expect(time)
        x = 0.6 * SETTINGS.slip if time >= slip_at else 0.0
        assert estimator.correct(sighting(Pose(x, 0.0, 0.0), time)), f"at {time:.3f} s"


def test_the_covariance_that_is_carried_is_the_predicted_one() -> None:
    """To now, as the filter itself would be predicted there: F P F' + Q."""
    stroll = Stroll(5)
    carried = Carried(Pose(0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    for index in range(120):
        stroll.step()
        if index > 3:
            stroll.look()
            carried = stroll.estimator.carry(stroll.now)
            xx, xy, xh, yy, yh, hh = carried.covariance
            assert carried.sigma == pytest.approx([math.sqrt(each) for each in (xx, yy, hh)])
            assert np.linalg.eigvalsh([[xx, xy, xh], [xy, yy, yh], [xh, yh, hh]]).min() > 0.0
    captured = list(stroll.truth)[-1]
    stroll.estimator.expect(captured)
    (xx, xy, xh), (_, yy, yh), (_, _, hh) = stroll.estimator.covariance
    assert carried.covariance == pytest.approx((xx, xy, xh, yy, yh, hh), rel=1e-12, abs=1e-20)
