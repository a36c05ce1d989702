"""An empty plate is never taken for a robot, whatever the light does and whatever lies about."""

from __future__ import annotations

import pytest
from scene_follower import tracker_of

from vision.simulated.scenes import SCENES, play

EMPTY = (
    "clean",
    "dim",
    "glare",
    "exposure_steps",
    "flicker",
    "debris",
    "jpeg",
    "everything",
    "small_robot",
    "dark_plate",
)
FRAMES = 10_000, 600
RUN = 60
"""Pictures in a row from one seed."""


@pytest.mark.parametrize("name", EMPTY)
def test_an_empty_plate_is_never_taken_for_a_robot(name: str, full: bool):
    runs = FRAMES[0 if full else 1] // (RUN * len(EMPTY))
    for seed in range(runs + 1):
        tracker = tracker_of(SCENES[name])
        for shown in play(SCENES[name], seed, RUN, robot=False):
            observation = tracker.update(shown.frame, None)
            assert observation.measurement is None, f"seed {seed}, frame {shown.frame.index}"
