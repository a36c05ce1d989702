"""Rows 1 to 8 and 19: what can go wrong between the robot and its measured pose."""

from __future__ import annotations

from tests.faults.trial import keeps_its_promise


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


def test_pictures_without_a_time_hold_the_robot() -> None:
    """A picture whose time is not a number is not looked at; the camera counts as dead."""
    keeps_its_promise("camera_timeless")


def test_a_hidden_robot_is_not_driven() -> None:
    """When something covers the robot, it is driven by prediction for 0.15 s at most; you resume when it
    is seen again."""
    keeps_its_promise("robot_hidden")


def test_a_false_sighting_is_not_followed() -> None:
    """When the tracker sees the robot far from where it can be, the rig does not believe it, and holds."""
    keeps_its_promise("sighting_jumps")


def test_a_sighting_that_is_no_number_is_refused() -> None:
    """A pose that is not a number never reaches the filter; without other sightings the rig holds."""
    keeps_its_promise("sighting_nan")
