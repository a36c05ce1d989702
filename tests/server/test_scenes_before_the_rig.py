"""The simulated rig in the scenes that trackers are judged by."""

from __future__ import annotations

import pytest
from pydantic import ValidationError

from control.model import Tracking
from control.snapshot import RigState
from server.settings import RigFile
from tests.faults.fault_bench import FaultBench, fault_bench
from vision.simulated.scene_names import FOR_ANY_LENS

FEW = ("exposure_steps", "everything")
MANY = ("second_robot", "larger_twin", "standing_twins")
ANOTHER_ROBOT = ("end_mark", "dark_plate", "blue_on_wood", "green_on_white", "white_on_slate")
"""Not of the colour that the rig file says."""
WALKED_THROUGH = [name for name in FOR_ANY_LENS if "hand" not in name and name not in (*MANY, *ANOTHER_ROBOT)]
SOMETHING_ELSE = 0.005
"""An estimate this far off the robot, m, is that of another thing."""


def in_scene(name: str) -> RigFile:
    return RigFile().with_simulation(seed=3, scene=name)


def is_true(bench: FaultBench) -> bool:
    pose, truth = bench.snapshot.pose, bench.world.body().pose
    return pose is not None and truth.distance_to(pose.x, pose.y) < SOMETHING_ELSE


def test_the_robot_walks_through_every_light_and_litter(full: bool) -> None:
    for name in WALKED_THROUGH if full else FEW:
        with fault_bench(in_scene(name)) as bench:
            bench.walk()
            walks_on(bench, 120)


@pytest.mark.parametrize("name", MANY)
def test_among_its_like_the_robot_that_the_operator_points_at_walks(name: str) -> None:
    with fault_bench(in_scene(name)) as bench:
        bench.run_for(0.5)
        assert bench.snapshot.tracking is Tracking.LOST
        pose = bench.world.body().pose
        bench.machine.tracker.follow(*bench.machine.camera_model.to_pixel(pose.x, pose.y))
        bench.walk()
        walks_on(bench, 60)


def walks_on(bench: FaultBench, frames: int) -> None:
    for _ in range(frames):
        bench.tick()
        assert is_true(bench) or bench.snapshot.tracking is not Tracking.LOCKED
    assert bench.snapshot.rig is RigState.RUNNING, bench.snapshot.reason


def test_an_unknown_scene_is_refused_with_what_there_is() -> None:
    with pytest.raises(
        ValidationError, match="no scene called 'moon'; choose one of: clean, dim, warm, shadow"
    ):
        in_scene("moon")
