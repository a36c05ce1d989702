"""A robot that was covered is back in three pictures, as long as it may have been covered, and the right way round."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from scene_follower import follow, followed, tracker_of

from control.model import PIVOT_A, Body, Frame, Pose, wrap
from vision.simulated.company import hand
from vision.simulated.rendering import Painter
from vision.simulated.scenes import SCENES, Scene, play

SEEDS = 60, 4
SOON = 3
"""Pictures until the robot is measured again."""
LARGEST_ERROR = 0.0004
"""Of a sighting of a robot that a hand's edge covers in part, m: the rest is refused."""


@pytest.fixture
def seeds(full: bool) -> range:
    return range(SEEDS[0 if full else 1])


@pytest.mark.parametrize("longest", [0.12, 0.4, 1.0])
def test_a_covered_robot_is_measured_again_in_the_third_picture_at_the_latest(longest: float, seeds: range):
    scene = Scene("covered", (hand(longest, 0.1),))
    for seed in seeds:
        waited = None
        for each in follow(scene, play(scene, seed, 150)):
            if not each.is_plain:
                waited = 0
            elif waited is not None:
                waited += 1
                if each.pose is not None:
                    assert each.turn < math.radians(5.0), f"seed {seed}, frame {each.shown.frame.index}"
                    waited = None
            assert waited is None or waited < SOON, f"seed {seed}, frame {each.shown.frame.index}"


def test_a_slow_hand_does_not_push_the_sighting_aside(seeds: range):
    scene = Scene("slow hand", (hand(0.3, 2.0),))
    for seed in seeds:
        for each in follow(scene, play(scene, seed, 110)):
            assert each.pose is None or each.offset < LARGEST_ERROR, f"seed {seed}, {each.shown.frame.index}"


@pytest.mark.parametrize("name", ["hand", "twin_and_hand", "larger_twin_and_hand"])
def test_in_the_scenes_with_a_hand_the_robot_stays_itself(name: str, seeds: range):
    for seed in seeds:
        for each in followed(name, seed, 100):
            assert each.pose is None or (each.offset < 0.004 and each.turn < 0.5 * math.pi)


@pytest.mark.parametrize("turned", [0.5, 1.7, math.pi, 4.0])
@pytest.mark.parametrize("gone", [0.5, 20.0])
def test_with_a_mark_on_its_end_a_robot_may_turn_as_it_likes_while_it_is_away(turned: float, gone: float):
    scene = SCENES["end_mark"]
    painter = Painter(scene.optics, scene.settings)
    before = Body(Pose(0.01, 0.0, 0.3), PIVOT_A, 0.0)
    after = replace(before, pose=replace(before.pose, heading=before.pose.heading + turned))
    tracker = tracker_of(scene, before.pose.heading)
    for index in range(10):
        tracker.update(Frame(painter.paint(before, index), index / 60, index), None)
    headings = []
    for index in range(10, 20):
        observation = tracker.update(Frame(painter.paint(after, index), index / 60 + gone, index), None)
        if observation.measurement is not None:
            headings.append(observation.measurement.pose.heading)
    assert headings
    assert max(abs(wrap(heading - after.pose.heading)) for heading in headings) < math.radians(2.0)


def test_a_mark_names_the_ends_although_the_hint_is_wrong():
    scene = SCENES["end_mark"]
    painter = Painter(scene.optics, scene.settings)
    body = Body(Pose(0.0, 0.01, 1.0), PIVOT_A, 0.0)
    tracker = tracker_of(scene, body.pose.heading + math.pi)
    seen = [tracker.update(Frame(painter.paint(body, index), index / 60, index), None) for index in range(8)]
    measured = [each.measurement for each in seen if each.measurement is not None]
    assert abs(wrap(measured[0].pose.heading - body.pose.heading)) < math.radians(2.0)


@pytest.mark.parametrize("name", ["clean", "end_mark"])
def test_it_is_said_whether_anything_but_the_hint_tells_the_ends(name: str):
    scene = SCENES[name]
    painter = Painter(scene.optics, scene.settings)
    body = Body(Pose(0.0, 0.01, 1.0), PIVOT_A, 0.0)
    tracker = tracker_of(scene, body.pose.heading)
    seen = [tracker.update(Frame(painter.paint(body, index), index / 60, index), None) for index in range(8)]
    assert seen[-1].measurement is not None
    assert seen[-1].assumes_ends == (name == "clean")
