"""Row 7: two robots alike, or two ends alike, and nothing that tells them apart."""

from __future__ import annotations

import pytest

from control.loop import ASSUMED_ENDS
from control.model import Tracking
from control.safety import Refused
from control.snapshot import RigState
from server.settings import RigFile
from server.vision_settings import colour_section
from tests.faults.fault_bench import FaultBench, fault_bench
from tests.faults.invariants import nothing_left_behind
from vision.simulated.scenes import SCENES


def test_a_rig_that_sees_two_alike_cannot_be_armed_until_the_right_one_is_clicked(bench: FaultBench) -> None:
    bench.run_for(0.3)
    bench.inject("second_robot", distance_mm=20.0)
    bench.machine.tracker.reset()
    bench.machine.loop.parts.perception.forget()
    snapshot = bench.run_for(2.0)
    assert snapshot.tracking is Tracking.LOST
    assert snapshot.tracking_reason == "2 blobs look like the robot: click the right one"
    with pytest.raises(Refused, match="2 blobs look like the robot: click the right one"):
        bench.arm_now()
    assert snapshot.observation is not None
    assert len(snapshot.observation.rivals) == 2
    pose = bench.world.body().pose
    camera = bench.machine.camera_model
    bench.machine.tracker.follow(*camera.to_pixel(pose.x, pose.y, bench.machine.body_height))
    snapshot = bench.run_for(0.2)
    assert snapshot.pose is not None
    assert pose.distance_to(snapshot.pose.x, snapshot.pose.y) < 5e-4
    bench.walk()


def test_a_click_on_the_other_one_is_followed_at_once_when_the_rig_is_disarmed(bench: FaultBench) -> None:
    bench.run_for(0.3)
    bench.inject("second_robot", distance_mm=20.0)
    snapshot = bench.run_for(0.5)
    assert snapshot.observation is not None
    (other,) = snapshot.observation.rivals
    bench.machine.tracker.follow(*other)
    snapshot = bench.run_for(0.5)
    assert snapshot.rig is RigState.DISARMED
    assert snapshot.tracking is Tracking.LOCKED
    truth = bench.world.body().pose
    assert snapshot.pose is not None
    assert truth.distance_to(snapshot.pose.x, snapshot.pose.y) == pytest.approx(0.020, abs=0.001)


@pytest.mark.parametrize("scene", ["clean", "end_mark"])
def test_arming_says_when_nothing_but_the_rig_file_tells_which_end_is_a(scene: str) -> None:
    settings = RigFile().with_simulation(seed=3, scene=scene)
    if mark := SCENES[scene].end_colour:
        vision = settings.vision.model_copy(update={"end_mark": colour_section(mark)})
        settings = settings.model_copy(update={"vision": vision})
    with nothing_left_behind(), fault_bench(settings) as bench:
        bench.arm()
        bench.run_for(0.3)
        said = [event.message for event in bench.trace.events if event.code == "heading"]
        assert said == ([ASSUMED_ENDS] if scene == "clean" else [])
