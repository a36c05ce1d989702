import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from server.api.replay import LONGEST, NotAsked, request_in
from server.replay.again import differences, label_again
from server.replay.shown import TRAIL, Course, Instant, ReplaySource, robot_of
from server.scene.geometry import geometry_of
from server.settings import RigFile
from server.settings_in_si import coil_set

TICK = {
    "pose": {"x_mm": 10.0, "y_mm": -20.0, "heading_deg": 90.0},
    "command": {"pivot": -1},
    "reference": {"x_mm": 12.0, "y_mm": -18.0},
    "body_tilt_deg": 5.0,
    "currents_A": [1.0, None, -0.5],
}


def course(length=100):
    times = np.arange(length, dtype=float)
    return Course([(0.0, np.zeros((2, 2)))], times, np.column_stack([times, -times]) * 1e-3)


def test_the_differences_of_two_rig_files_are_named_with_both_values():
    then, now = RigFile(), RigFile().with_simulation(seed=7, plant="noslip")
    found = differences(then.model_dump(mode="json"), now.model_dump(mode="json"))
    assert [(each.name, each.then, each.now) for each in found] == [
        ("simulation.plant", "slip", "noslip"),
        ("simulation.seed", 1, 7),
    ]
    assert found[1].words == "simulation.seed was 1 and is 7 now"


def test_the_same_rig_file_has_no_differences():
    assert differences(RigFile().model_dump(mode="json"), RigFile().model_dump(mode="json")) == []


def test_a_value_that_one_version_does_not_have_is_a_difference():
    found = differences(
        {"robot": {"length_mm": 10.0, "wings": 2}}, {"robot": {"length_mm": 10.0}, "lamp": {"on": True}}
    )
    assert [each.words for each in found] == [
        "lamp.on was not there and is true now",
        "robot.wings was 2 and is not there now",
    ]


@pytest.mark.parametrize(
    ("label", "expected"),
    [("", "again"), ("eight", "eight again"), ("eight again", "eight again"), ("against", "against again")],
)
def test_a_run_that_is_started_again_says_so_once(label, expected):
    assert label_again(label) == expected
    assert label_again(expected) == expected


@given(at=st.floats(0.0, LONGEST), frame=st.booleans())
def test_a_request_within_the_allowed_times_is_understood(at, frame):
    request = request_in(f'{{"at_s": {at!r}, "frame": {str(frame).lower()}}}')
    assert (request.at_s, request.frame) == (at, frame)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "3",
        "[]",
        "{}",
        '{"at_s": NaN}',
        '{"at_s": 1e999}',
        '{"at_s": -0.1}',
        '{"at_s": 2e6}',
        '{"at_s": "1"}',
        '{"at_s": 1, "frame": 1}',
        '{"at_s": 1, "x": 2}',
        b"\xff\xfe",
        "[" * 5000,
    ],
)
def test_anything_else_is_refused_in_words(text):
    with pytest.raises(NotAsked) as refused:
        request_in(text)
    assert "at_s" in str(refused.value)


@given(at=st.floats(-10.0, 1e4))
def test_the_trail_holds_the_places_of_the_last_minute_and_none_of_the_future(at):
    whole = course()
    shown = whole.until(at)
    times = shown[:, 0] * 1e3
    assert np.all(times <= at + 1e-9)
    assert np.all(times > at - TRAIL - 1e-9)
    assert len(shown) == np.count_nonzero((whole.times <= at) & (whole.times > at - TRAIL))


def test_a_recorded_robot_stands_in_the_scene_where_its_tick_says():
    robot = robot_of(TICK, course(), 3.0)
    assert robot.pose is not None
    assert (robot.pose.x, robot.pose.y, robot.pose.heading) == pytest.approx((0.01, -0.02, math.pi / 2))
    assert robot.target == pytest.approx((0.012, -0.018))
    assert robot.pivot == -1
    assert robot.body_tilt == pytest.approx(math.radians(5.0))
    assert len(robot.trail) == 4


def test_a_robot_that_is_not_known_yet_is_not_shown():
    assert robot_of(None, course(), 3.0).pose is None
    assert robot_of({**TICK, "reference": None}, course(), 3.0).target is None
    assert robot_of({**TICK, "pose": None}, course(), 3.0).pose is None
    assert (
        robot_of({**TICK, "pose": {"x_mm": None, "y_mm": 1.0, "heading_deg": 2.0}}, course(), 3.0).pose
        is None
    )


def test_two_recordings_have_two_robots_and_the_field_of_the_first():
    rig = RigFile()
    source = ReplaySource(geometry_of(rig, coil_set(rig)), [course(), course(2)])
    view = source.view(Instant(1.0, [TICK, None]))
    assert view.currents == (1.0, 0.0, -0.5)
    assert [robot.pose is None for robot in view.robots] == [False, True]
