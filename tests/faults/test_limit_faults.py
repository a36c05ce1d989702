"""Rows 20 and 22: the edge of the workspace and the heat of the coils."""

from __future__ import annotations

from tests.faults.trial import keeps_its_promise


def test_a_robot_that_was_put_outside_is_not_driven() -> None:
    """When somebody puts the robot down outside the workspace, it is not driven; put back, it is found,
    and you resume."""
    keeps_its_promise("robot_put")


def test_a_coil_that_is_too_hot_is_switched_off() -> None:
    """When a coil has reached its heat, the rig holds and says how long it must rest."""
    keeps_its_promise("coil_hot")
