"""What is let in at the seams: pictures of the right shape, and values that are finite numbers; pure."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from control.link.conversion import Telemetry
from control.model import Frame, Observation


def frame_problem(frame: Frame, size: tuple[int, int]) -> str:
    """Why this is no picture of a camera of `size` (width, height in px); "" when it is one."""
    width, height = size
    image = frame.image
    if image.shape != (height, width, 3) or image.dtype != np.uint8:
        return (
            f"the camera sends pictures of shape {image.shape} ({image.dtype}) where ({height}, {width}, 3) (uint8) "
            "is expected: is it this rig's camera, and is camera.size_px in the rig file right?"
        )
    return ""


def without_nonsense(observation: Observation) -> Observation:
    """The same without a sighting that is not finite."""
    seen = observation.measurement
    if seen is None or (seen.pose.is_finite and math.isfinite(seen.captured_at)):
        return observation
    return replace(observation, measurement=None)


def is_sound(telemetry: Telemetry) -> bool:
    """Whether all that the host reckons with is a finite number."""
    numbers = (
        telemetry.received_at,
        telemetry.board_time,
        telemetry.heading,
        telemetry.elevation,
        telemetry.supply,
        *telemetry.currents,
        *telemetry.measured_currents,
        *telemetry.duty,
    )
    return all(map(math.isfinite, numbers))
