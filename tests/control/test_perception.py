"""What the rig believes of its tracker, and for how long."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from control.arbiter import PREDICT_FOR
from control.estimator import EstimatorSettings
from control.field_model import FieldModel
from control.model import PIVOT_A, Expectation, Frame, Measurement, Observation, Pose, Tracking, swing
from control.perception import NOT_BELIEVED, Perception

PERIOD = 1.0 / 60.0
LENGTH = 0.010
HERE = Pose(0.010, -0.005, 0.7)
FAR = replace(HERE, x=0.040)
HELD_STILL = EstimatorSettings(free_position=0.0002, free_heading=math.radians(2.0))
"""A robot that nobody pushes."""


class Script:
    """A tracker that sees the robot where it is told to."""

    def __init__(self) -> None:
        self.pose: Pose | None = HERE

    def update(self, frame: Frame, expected: Expectation | None) -> Observation:
        del expected
        if self.pose is None:
            return Observation(Tracking.LOST, None, (0, 0, 1, 1), "something covers the robot")
        seen = Measurement(self.pose, frame.captured_at, (0.0, 0.0), (), 1.0)
        return Observation(Tracking.LOCKED, seen, (0, 0, 1, 1))

    def reset(self) -> None: ...


class Watching:
    def __init__(self, settings: EstimatorSettings = HELD_STILL) -> None:
        self._script = Script()
        self.perception = Perception(self._script, FieldModel(0.05, 0.03), settings, LENGTH, 0.05)
        self._index = 0

    def sees(self, pose: Pose | None, count: int = 1) -> Tracking:
        for _ in range(count):
            self._script.pose = pose
            picture = np.full((32, 32, 3), self._index % 251, np.uint8)
            self.perception.look(Frame(picture, self._index * PERIOD, self._index))
            self._index += 1
        return self.perception.tracking


@pytest.fixture
def watching() -> Watching:
    return Watching()


def test_an_unseen_robot_is_predicted_for_150_ms_and_then_lost_with_the_reason(watching: Watching):
    assert watching.sees(HERE, 10) is Tracking.LOCKED
    assert watching.perception.reason == ""
    assert watching.sees(None, round(PREDICT_FOR / PERIOD)) is Tracking.PREDICTED
    assert watching.sees(None) is Tracking.LOST
    assert watching.perception.reason == "something covers the robot"
    assert watching.perception.pose_at(1.0)[0] is None


def test_a_robot_that_may_be_more_than_its_length_away_is_lost_before_that():
    """With 10 mm per root second a third of a body length of standard deviation is reached after 0.11 s."""
    pushed = Watching(EstimatorSettings(free_position=0.010))
    pushed.sees(HERE, 10)
    assert pushed.sees(None, 6) is Tracking.PREDICTED
    assert pushed.sees(None, 2) is Tracking.LOST


def test_a_sighting_far_from_the_prediction_is_not_believed(watching: Watching):
    watching.sees(HERE, 10)
    assert watching.sees(FAR, 5) is Tracking.PREDICTED
    assert watching.perception.reason == NOT_BELIEVED
    pose, _ = watching.perception.pose_at(0.25)
    assert pose is not None
    assert pose.distance_to(HERE.x, HERE.y) < 1e-4


def test_sightings_that_are_wrong_as_often_as_right_lose_the_robot_in_the_end(watching: Watching):
    watching.sees(HERE, 10)
    seen = [watching.sees(pose) for _ in range(30) for pose in (FAR, HERE)]
    assert Tracking.LOST not in seen[:30]
    assert Tracking.LOST in seen


def test_now_and_then_a_wrong_sighting_does_no_harm(watching: Watching):
    watching.sees(HERE, 10)
    seen = [watching.sees(pose) for _ in range(100) for pose in (FAR, HERE, HERE, HERE)]
    assert Tracking.LOST not in seen


def test_after_a_loss_doubt_begins_anew(watching: Watching):
    watching.sees(HERE, 10)
    assert watching.sees(FAR, 11) is not Tracking.PREDICTED
    assert watching.sees(FAR) is Tracking.LOCKED
    assert watching.sees(HERE, 5) is Tracking.PREDICTED


def test_a_robot_that_stands_in_a_field_which_has_come_up_anew_teaches_nothing_about_its_play() -> None:
    """The field comes up along its heading, so that it does not lead, whichever way it led before."""
    play = math.radians(3.0)
    script, field = Script(), FieldModel(0.05, 0.03)
    perception = Perception(script, field, HELD_STILL, LENGTH, 2.0 * play)

    def look(frames: range) -> None:
        for index in frames:
            field.advance(index * PERIOD)
            led = field.heading_at(index * PERIOD - HELD_STILL.actuation_delay) - HERE.heading - play
            if field.is_on and led > 0.0:
                script.pose = swing(HERE, PIVOT_A, led, LENGTH)
            perception.look(Frame(np.full((32, 32, 3), index % 251, np.uint8), index * PERIOD, index))

    field.start(0.0, HERE.heading, PIVOT_A, 0.4, 0.001)
    look(range(1, 10))
    field.command(PIVOT_A, 0.4, 1.2, HERE.heading + 0.4)
    look(range(10, 40))
    assert perception.estimator.grip.is_tight
    assert perception.backlash.half_width == pytest.approx(play, rel=0.1)
    walked, here = perception.backlash.half_width, perception.pose_at(39 * PERIOD)[0]
    assert here is not None
    field.stop(39 * PERIOD)
    look(range(40, 60))
    field.start(59 * PERIOD, here.heading, PIVOT_A, 0.4, 0.001)
    look(range(60, 160))
    assert perception.backlash.half_width == walked
