"""Rows 1 to 8 and 19: what can go wrong between the robot and its measured pose."""

from __future__ import annotations

import pytest

from control.arbiter import FRAME_TOO_LATE
from control.model import Tracking
from control.safety import Refused
from control.snapshot import RigState
from server.calibration.optics import assumed_model
from server.settings import RigFile
from tests.faults.fault_bench import FaultBench, fault_bench
from tests.faults.invariants import (
    check_announced,
    check_limits,
    check_stays_zero,
    check_zero,
    nothing_left_behind,
)
from tests.faults.trial import keeps_its_promise
from vision.simulated.camera import SyntheticCamera

WALKS_ON_OR_IS_HELD = (RigState.RUNNING, ""), (RigState.HELD, "lost"), (RigState.HELD, "frozen")
"""Pictures that are white all over are alike: they count as frozen."""
HALF_A_LENGTH = 0.005
"""Of the robot, m."""


def test_an_unplugged_camera_holds_the_robot() -> None:
    """When the camera's cable comes out, the coils are off a tenth of a second later; when it is back, you
    resume."""
    keeps_its_promise("camera_unplugged")


def test_a_frozen_picture_holds_the_robot() -> None:
    """When the camera sends the same picture again and again, the coils are off at the third one."""
    keeps_its_promise("camera_frozen")


def test_late_pictures_hold_the_robot() -> None:
    """When pictures arrive too late to steer by, the coils are off until they are fresh again and you
    resume."""
    keeps_its_promise("camera_late")


def test_a_picture_steers_for_so_long_after_it_was_taken_and_no_longer(bench: FaultBench) -> None:
    """Pictures that are late, but not too late, become too old while no others come."""
    bench.walk()
    bench.inject("camera_late", extra_ms=80.0)
    bench.run_for(0.5)
    assert bench.snapshot.rig is RigState.RUNNING, bench.snapshot.reason
    bench.inject("camera_unplugged")
    while bench.snapshot.rig is RigState.RUNNING:
        frame = bench.loop.parts.perception.frame
        assert frame is not None
        assert bench.now - frame.captured_at <= FRAME_TOO_LATE
        bench.tick()
    assert bench.snapshot.rig is RigState.HELD


def test_a_few_lost_pictures_change_nothing() -> None:
    """When a third of the pictures is lost, the robot walks on."""
    keeps_its_promise("camera_drops")


def test_a_mirrored_picture_holds_the_robot() -> None:
    """When the camera suddenly shows everything mirrored, the robot is not followed to where it is not.
    Found again, its two ends may be taken for each other: the rig notices by how it turns, and you arm once more."""
    keeps_its_promise("camera_mirrored")


def test_pictures_of_another_size_disarm() -> None:
    """When the camera suddenly sends pictures of another size, the rig disarms and names both sizes."""
    keeps_its_promise("camera_cropped")


def test_another_camera_than_the_calibrated_one_disarms() -> None:
    """When another camera takes the place of the one that was calibrated, the rig disarms and names both."""
    lens = assumed_model(RigFile().camera)
    section = {
        "identity": "simulated camera", "date": "2026-01-01 10:00:00", "size_px": list(lens.size), "fx": lens.fx,
        "fy": lens.fy, "cx": lens.cx, "cy": lens.cy, "distortion": list(lens.distortion), "residual_px": 0.05,
    }  # fmt: skip
    calibrated = RigFile.model_validate({"camera": {"lens": section}}).with_simulation(seed=3)
    with nothing_left_behind(), fault_bench(calibrated) as bench:
        bench.walk()
        camera = bench.machine.camera
        assert isinstance(camera, SyntheticCamera)
        before, exchanged = bench.now, bench.board.milliseconds
        camera.identity = "usb 046d:0825 ABC123"
        bench.run_for(1.0)
        assert bench.snapshot.rig is RigState.DISARMED, bench.snapshot.reason
        assert '"usb 046d:0825 ABC123"' in bench.snapshot.reason
        assert '"simulated camera"' in bench.snapshot.reason
        check_stays_zero(bench.trace, check_zero(bench.trace, bench.electrics, exchanged))
        check_limits(bench.trace.samples, bench.electrics)
        check_announced(bench.trace, "calibration", before)
        with pytest.raises(Refused, match="calibrated for another camera"):
            bench.arm_now()
        camera.identity = "simulated camera"
        bench.go_on()


def test_pictures_without_a_time_hold_the_robot() -> None:
    """A picture whose time is not a number is not looked at; the camera counts as dead."""
    keeps_its_promise("camera_timeless")


def test_a_hidden_robot_is_not_driven() -> None:
    """When something covers the robot, it is driven by prediction for 0.15 s at most; you resume when it
    is seen again."""
    keeps_its_promise("robot_hidden")


def test_darkness_holds_the_robot() -> None:
    """When the lamp goes out, the robot is driven by prediction for 0.15 s at most; you resume when it is light."""
    keeps_its_promise("light_off")


def test_a_jump_of_the_exposure_changes_nothing() -> None:
    """When everything is twice as bright from one picture to the next, the robot walks on."""
    keeps_its_promise("exposure_jump")


def test_flickering_light_changes_nothing() -> None:
    """When dark bands wander through the picture, the robot walks on."""
    keeps_its_promise("flicker")


def test_with_a_white_spot_on_it_the_robot_walks_on_or_is_held() -> None:
    """When a lamp is mirrored in the robot, the rest of it is enough to walk on, or it counts as covered."""
    keeps_its_promise("glare")


def test_a_hand_over_the_robot_holds_it() -> None:
    """When a hand covers the robot, it is driven by prediction for 0.15 s at most; you resume when the hand is
    gone."""
    keeps_its_promise("hand")


def test_a_second_robot_changes_nothing() -> None:
    """When another robot just like it lies on the plate, the first one is followed on."""
    keeps_its_promise("second_robot")


def test_bits_on_the_plate_change_nothing() -> None:
    """When specks, fibres and flakes lie about, some of them in the robot's colour, the robot walks on."""
    keeps_its_promise("debris")


@pytest.mark.parametrize("factor", [0.05, 0.5, 10.0])
def test_however_the_exposure_jumps_the_robot_walks_on_or_is_held(bench: FaultBench, factor: float) -> None:
    """Never is anything else taken for it; light again, you resume."""
    bench.walk()
    reaction = bench.react("exposure_jump", factor=factor)
    assert (reaction.after, reaction.code) in WALKS_ON_OR_IS_HELD
    assert estimate_is_true(bench) or bench.snapshot.tracking is not Tracking.LOCKED
    bench.mend("exposure_jump")
    if bench.snapshot.rig is RigState.HELD:
        bench.go_on()
    assert estimate_is_true(bench)


def test_a_blink_of_darkness_is_walked_through(bench: FaultBench) -> None:
    bench.walk()
    bench.faults.inject("light_off", duration=0.1)
    bench.run_for(0.5)
    assert bench.snapshot.rig is RigState.RUNNING, bench.snapshot.reason
    assert estimate_is_true(bench)


@pytest.mark.parametrize("distance_mm", [12.0, 25.0])
def test_a_twin_is_not_taken_for_the_robot_that_is_hidden(bench: FaultBench, distance_mm: float) -> None:
    """When the robot is covered and only its twin is seen, the rig holds until the robot itself is back."""
    bench.walk()
    bench.inject("second_robot", distance_mm=distance_mm)
    bench.run_for(0.3)
    assert bench.snapshot.rig is RigState.RUNNING, bench.snapshot.reason
    bench.inject("robot_hidden")
    for _ in range(60):
        bench.tick()
        assert bench.snapshot.tracking is not Tracking.LOCKED or estimate_is_true(bench)
    assert bench.snapshot.rig is RigState.HELD
    bench.mend("robot_hidden")
    bench.go_on()
    assert estimate_is_true(bench)


def estimate_is_true(bench: FaultBench) -> bool:
    """Whether the estimate is where the robot is, within half a body length."""
    pose, truth = bench.snapshot.pose, bench.world.body().pose
    return pose is not None and truth.distance_to(pose.x, pose.y) < HALF_A_LENGTH


def test_a_false_sighting_is_not_followed() -> None:
    """When the tracker sees the robot far from where it can be, the rig does not believe it, and holds."""
    keeps_its_promise("sighting_jumps")


def test_a_sighting_that_is_no_number_is_refused() -> None:
    """A pose that is not a number never reaches the filter; without other sightings the rig holds."""
    keeps_its_promise("sighting_nan")
