"""The robot that is followed is never taken for another one, whoever is beside it and whatever covers them."""

from __future__ import annotations

import pytest
from near_company import KINDS, covered_among, free_among
from scene_follower import Seen, follow

from vision.simulated.scenes import Scene, play

FRAMES = 72
"""Of a sequence: 1.2 s."""
MOST_REFUSED = 0.05
"""Share of the pictures that show the whole robot and get no answer."""
SAME = 0.004
"""A sighting further than that from the robot's centre is of another one, m: they are 10 mm away at least."""
SEQUENCES = 1000, 30


def sequence(scene: Scene, seed: int) -> list[Seen]:
    return list(follow(scene, play(scene, seed, FRAMES)))


@pytest.fixture
def sequences(full: bool) -> int:
    return SEQUENCES[0 if full else 1]


def test_no_sequence_takes_another_one_for_the_robot_and_few_pictures_get_no_answer(sequences: int):
    kinds = [covered_among(kind) for kind in KINDS] + [free_among(kind) for kind in KINDS]
    errors, plain, refused = [], 0, 0
    for seed in range(sequences):
        seen = sequence(kinds[seed % len(kinds)], seed)
        errors += [seed for each in seen if each.pose is not None and each.offset > SAME]
        plain += sum(each.is_plain for each in seen)
        refused += sum(each.is_plain and each.pose is None for each in seen)
    assert errors == []
    assert refused <= MOST_REFUSED * plain
