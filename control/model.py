"""The robot's pose, its two pivots and its exact-arc kinematics, and the values that stages hand on.

Frames: the workspace plane has its origin at the coil centre, x to the right and y up in the camera
picture. The heading is the angle of the local x axis, the direction of walking; the robot's long axis
B -> A is the local +y axis (paper, section 2).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

Pivot = Literal[1, -1]
"""The active pivot, the paper's sigma: +1 is end A, -1 is end B."""

PIVOT_A: Pivot = 1
PIVOT_B: Pivot = -1
TURN = 2.0 * math.pi


class Place(Protocol):
    """What the formulas ask of a pose, which a compiled walk keeps in another form: m, m, rad."""

    @property
    def x(self) -> float: ...
    @property
    def y(self) -> float: ...
    @property
    def heading(self) -> float: ...


def wrap(angle: float) -> float:
    """The same angle in [-pi, pi), rad."""
    return (angle + math.pi) % TURN - math.pi


def opposite(pivot: Pivot) -> Pivot:
    return PIVOT_B if pivot == PIVOT_A else PIVOT_A


@dataclass(frozen=True, slots=True)
class Pose:
    """The robot's centre (m, workspace frame) and heading (rad; unwrapped wherever it is integrated)."""

    x: float
    y: float
    heading: float

    @property
    def is_finite(self) -> bool:
        return math.isfinite(self.x) and math.isfinite(self.y) and math.isfinite(self.heading)

    def distance_to(self, x: float, y: float) -> float:
        """Distance from the centre to a point, m."""
        return math.hypot(self.x - x, self.y - y)


def distance(x: float, y: float, other_x: float, other_y: float) -> float:
    """Between two places, m; made of what compiled code computes to the same last digit, as `hypot` is not."""
    x, y = x - other_x, y - other_y
    return math.sqrt(x * x + y * y)


def pivot_point(pose: Place, pivot: Pivot, length: float) -> tuple[float, float]:
    """Where end A (pivot +1) or B (pivot -1) stands, m; `length` is the distance between the ends, m."""
    half = 0.5 * length * pivot
    return pose.x - half * math.sin(pose.heading), pose.y + half * math.cos(pose.heading)


def swing(pose: Pose, pivot: Pivot, angle: float, length: float) -> Pose:
    """The pose after turning by `angle` (rad) about the active pivot: an exact arc, of any size.

    The closed form of the paper's eq. (1), so the pivot stays where it is whatever the step.
    """
    after = pose.heading + angle
    half = 0.5 * length * pivot
    return Pose(
        pose.x + half * (math.sin(after) - math.sin(pose.heading)),
        pose.y - half * (math.cos(after) - math.cos(pose.heading)),
        after,
    )


class Tracking(StrEnum):
    """What the camera knows of the robot."""

    LOCKED = "locked"
    PREDICTED = "predicted"
    LOST = "lost"


@dataclass(frozen=True, slots=True)
class Frame:
    """One camera picture.

    image: (height, width, 3) uint8, BGR; nobody writes to it once it is handed on.
    captured_at: mid-exposure on the rig's monotonic clock, s.  index: counts frames, gaps are drops.
    """

    image: NDArray[np.uint8]
    captured_at: float
    index: int


@dataclass(frozen=True, slots=True)
class CameraNote:
    """What a camera has to tell, in the operator's words. severity: "info" or "warn"."""

    severity: str
    message: str


@dataclass(frozen=True, slots=True)
class Expectation:
    """Where the estimator expects the robot in the frame that is about to be searched.

    pose: predicted pose at the frame's capture time.
    position_sigma, heading_sigma: one standard deviation of the position, m, and of the heading, rad; pi when the
    heading is anybody's guess.
    pivot, tilt: the end expected to be pressed down, and the elevation of the other one above the plate, rad:
    a raised end is nearer to the camera, which would otherwise turn and shift the measured pose.
    """

    pose: Pose
    position_sigma: float
    pivot: Pivot = PIVOT_A
    tilt: float = 0.0
    heading_sigma: float = math.pi


@dataclass(frozen=True, slots=True)
class Measurement:
    """One sighting of the robot.

    pose: measured pose at `captured_at`, workspace frame; the heading's 180 degree ambiguity is resolved.
    centre_image: (u, v) of the centre, px.  corners_image: four (u, v) corners of its rectangle, px.
    area_px: area of the blob, px^2.
    """

    pose: Pose
    captured_at: float
    centre_image: tuple[float, float]
    corners_image: tuple[tuple[float, float], ...]
    area_px: float


@dataclass(frozen=True, slots=True)
class Observation:
    """What the tracker makes of one frame.

    window: the searched region (u0, v0, u1, v1), px; the whole frame when there was nothing to expect.
    reason: why there is no measurement, in the operator's words; "" with one.
    rivals: (u, v) of other blobs that look like the robot, px.
    assumes_ends: which end is A was told by nothing but the rig file's hint.
    """

    tracking: Tracking
    measurement: Measurement | None
    window: tuple[int, int, int, int]
    reason: str = ""
    rivals: tuple[tuple[float, float], ...] = ()
    assumes_ends: bool = False


@dataclass(frozen=True, slots=True)
class Body:
    """The true robot, as the simulated camera sees it.

    pose: pose of the flat robot.  pivot: the end that is pressed down.
    tilt: elevation of the raised end above the plate, rad, 0 when it lies flat.
    """

    pose: Pose
    pivot: Pivot
    tilt: float


def body_tilt(elevation: float, lift_ratio: float) -> float:
    """How far the free end rises, rad, when the field has this elevation (rad) above the plate.

    Solves L sin(a - b) = cos b for b, with L = 2 m B / (W L) the magnet's torque over the weight's; 0 while
    L sin a <= 1, when the end does not lift.
    """
    lift = lift_ratio * math.sin(elevation) - 1.0
    return math.atan2(lift, lift_ratio * math.cos(elevation)) if lift > 0.0 else 0.0
