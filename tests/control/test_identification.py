"""Slip identification on walks whose slip is known: no camera, no rig."""

import math
import random
from dataclasses import astuple, dataclass

import pytest

from control.gait_model import GaitModel
from control.identification import Sample, TooLittle, identify, stands_of
from control.model import PIVOT_A, Pivot, Pose, opposite, swing, wrap

TILT = math.radians(25.0)
FRAME = 1.0 / 60.0
RAMP = 0.05
TRUE = GaitModel(
    length=0.0104,
    out=-0.00015,
    forward_base=0.00008,
    forward_per_sweep=0.00045,
    switch_time=RAMP,
    backlash=math.radians(3.0),
    heading_offset=math.radians(1.5),
)


@dataclass
class Walk:
    """A robot that slips exactly as `TRUE` says, and the camera that watches it."""

    noise: float = 0.0
    seed: int = 1
    skew: float = 0.0
    time: float = 0.0
    body: Pose = Pose(0.0, 0.0, 0.4)
    pivot: Pivot = PIVOT_A

    def __post_init__(self) -> None:
        self.samples: list[Sample] = []
        self.random = random.Random(self.seed)
        self.field = self.body.heading + TRUE.heading_offset

    def see(self, elevation: float) -> None:
        """Positions to 0.03 mm, headings to 0.1 degrees, times `noise`."""
        x = self.body.x + self.random.gauss(0.0, 3e-5 * self.noise)
        y = self.body.y + self.random.gauss(0.0, 3e-5 * self.noise)
        heading = self.body.heading - self.skew + self.random.gauss(0.0, math.radians(0.1) * self.noise)
        self.samples.append(Sample(self.time, Pose(x, y, wrap(heading)), self.field - self.skew, elevation))
        self.time += FRAME

    def sweep(self, angle: float, rate: float) -> None:
        """Turn the body by `angle`; the field leads by half the play."""
        direction = math.copysign(1.0, angle)
        goal = self.body.heading + angle
        led = TRUE.heading_offset + direction * 0.5 * TRUE.backlash
        self.see(-self.pivot * TILT)
        while direction * (goal - self.body.heading) > 1e-12:
            end = goal + led
            self.field = (
                min(self.field + rate * FRAME, end) if direction > 0 else max(self.field - rate * FRAME, end)
            )
            pulled = self.field - led - self.body.heading
            if direction * pulled > 0.0:
                self.body = swing(self.body, self.pivot, pulled, TRUE.length)
            self.see(-self.pivot * TILT)
        self.switch(angle)

    def switch(self, turn: float) -> None:
        """The field tips over in three frames, and the robot slips in the middle of it."""
        self.see(-self.pivot * 0.6 * TILT)
        self.see(-self.pivot * 0.2 * TILT)
        new, cosine, sine = opposite(self.pivot), math.cos(self.body.heading), math.sin(self.body.heading)
        forward = self.pivot * math.copysign(1.0, turn) * TRUE.forward(turn)
        across = new * TRUE.out
        self.body = Pose(
            self.body.x + forward * cosine - across * sine,
            self.body.y + forward * sine + across * cosine,
            self.body.heading,
        )
        self.pivot = new
        self.see(-self.pivot * 0.6 * TILT)

    def walk(self, sweeps: int) -> list[Sample]:
        """Straight on, in sweeps of 20 and 30 degrees."""
        for number in range(sweeps):
            width = math.radians(20.0 if number % 8 < 4 else 30.0)
            self.sweep(self.pivot * width, 1.7 if number % 3 else 0.9)
        return self.samples


def figures(model: GaitModel) -> tuple[float, ...]:
    return astuple(model)[:4] + astuple(model)[5:7]


def test_a_walk_without_noise_gives_the_figures_exactly() -> None:
    assert figures(identify(Walk().walk(40))) == pytest.approx(figures(TRUE), rel=1e-6, abs=1e-9)


def test_noise_stays_within_the_stated_uncertainty(full: bool) -> None:
    for seed in range(200 if full else 12):
        model = identify(Walk(noise=1.0, seed=seed).walk(60), switch_time=RAMP)
        assert model.switch_time == RAMP
        assert model.uncertainty is not None
        errors = astuple(model.uncertainty)[:6]
        pairs = zip(figures(model), figures(TRUE), errors, strict=True)
        assert all(abs(found - true) <= 4.0 * error for found, true, error in pairs), (seed, model)


def test_a_longer_walk_is_known_better() -> None:
    short, long = (identify(Walk(noise=1.0).walk(sweeps)).uncertainty for sweeps in (30, 240))
    assert short is not None
    assert long is not None
    assert long.forward_per_sweep < 0.7 * short.forward_per_sweep


def test_a_marker_that_is_stuck_on_askew_does_not_shorten_the_robot() -> None:
    model = identify(Walk(skew=math.radians(5.0)).walk(40))
    assert model.length == pytest.approx(TRUE.length, rel=1e-6)
    assert model.out == pytest.approx(TRUE.out, rel=1e-4)


def test_one_sweep_angle_alone_gives_the_displacement_at_that_angle() -> None:
    walk = Walk()
    for _ in range(40):
        walk.sweep(walk.pivot * math.radians(25.0), 1.5)
    turn = math.radians(25.0)
    assert identify(walk.samples).forward(turn) == pytest.approx(TRUE.forward(turn), rel=1e-3)


def test_a_walk_that_shows_too_little_says_what_is_missing() -> None:
    with pytest.raises(TooLittle, match="12 are needed; walk further"):
        identify(Walk().walk(6))
    with pytest.raises(TooLittle, match="shows 0 usable turns"):
        identify([])


def test_a_camera_that_never_sees_the_robot_at_rest_is_not_enough() -> None:
    settled = [sample for sample in Walk().walk(40) if abs(sample.elevation) > 0.9 * TILT]
    with pytest.raises(TooLittle, match="pictures a second"):
        identify(settled)


def test_turns_to_and_fro_about_one_pivot_are_left_out() -> None:
    walk = Walk()
    walk.walk(4)
    before = len(stands_of(walk.samples))
    pivot = walk.pivot
    for angle in (0.4, -0.4):
        walk.sweep(angle, 1.5)
        walk.pivot = pivot
        del walk.samples[-3:]
    walk.see(pivot * TILT)
    assert len(stands_of(walk.samples)) == before
