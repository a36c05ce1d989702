"""From a measured blob to the pose of the flat robot on the plate."""

from __future__ import annotations

import math
from dataclasses import dataclass

from control.model import PIVOT_A, Expectation, Measurement, Pivot, Pose, pivot_point, wrap
from vision.camera_model import CameraModel
from vision.tracking.detection import Blob
from vision.tracking.windows import Place

LARGEST_TILT = math.radians(60.0)
"""An expected tilt beyond this is none that the rig can command; the robot is then taken as flat."""


@dataclass(frozen=True, slots=True)
class Attitude:
    """How the robot stands: pressed end, elevation of the other end (rad)."""

    pivot: Pivot = PIVOT_A
    tilt: float = 0.0

    @classmethod
    def expected(cls, expected: Expectation | None) -> Attitude:
        """As the estimator expects it; flat when it expects nothing that can be."""
        if expected is None:
            return FLAT
        return cls(expected.pivot, expected.tilt if 0.0 <= expected.tilt <= LARGEST_TILT else 0.0)


FLAT = Attitude()


def remembered_side(blob: Blob, ahead: Place) -> int:
    """+1 when the blob's axis points from B to A, -1 when the other way; ahead: where A should be, (du, dv) px."""
    return 1 if ahead[0] * math.cos(blob.axis) + ahead[1] * math.sin(blob.axis) >= 0.0 else -1


class PoseReader:
    """length: of the body, m.  height: of its top surface above the plate, m.  scale: of the picture, px/m."""

    def __init__(self, camera: CameraModel, length: float, height: float, scale: float) -> None:
        self._camera = camera
        self._length = length
        self._height = height
        self._half = 0.5 * length * scale
        self.heading_offset = 0.0
        """From the heading that the body shows to that of its pivots, rad."""

    def ahead(self, place: Place, heading: float) -> Place:
        """Direction (du, dv; px) from the middle to end A in the picture, for a robot at a place (px)."""
        x, y = self._camera.to_point(*place, self._height)
        return self.ahead_of(Pose(x, y, heading), place)

    def ahead_of(self, pose: Pose, place: Place) -> Place:
        """The same for a pose whose place in the picture (px) is known."""
        shown = Pose(pose.x, pose.y, pose.heading - self.heading_offset)
        a_x, a_y = pivot_point(shown, PIVOT_A, self._length)
        a_u, a_v = self._camera.to_pixel(a_x, a_y, self._height)
        return a_u - place[0], a_v - place[1]

    def measurement(self, blob: Blob, side: int, captured_at: float, attitude: Attitude) -> Measurement:
        """The pose of the flat robot.

        The pressed end stays when it tilts; the other end rises and comes nearer to the camera. So the two
        halves of the long axis are mapped at the height of their own end, and the flat robot's centre lies
        L/2 (1 - cos(tilt)) further from the pressed end than the blob's does.
        """
        (u, v), half = blob.centre, self._half
        lift = self._length * math.sin(attitude.tilt)
        height_a, height_b = (0.0, lift) if attitude.pivot == PIVOT_A else (lift, 0.0)
        du, dv = side * half * math.cos(blob.axis), side * half * math.sin(blob.axis)
        x, y = self._camera.to_point(u, v, self._height + 0.5 * lift)
        ax, ay = self._camera.to_point(u + du, v + dv, self._height + height_a)
        bx, by = self._camera.to_point(u - du, v - dv, self._height + height_b)
        shown = math.atan2(ay - by, ax - bx) - 0.5 * math.pi
        shift = -0.5 * attitude.pivot * self._length * (1.0 - math.cos(attitude.tilt))
        place = x - shift * math.sin(shown), y + shift * math.cos(shown)
        pose = Pose(*place, wrap(shown + self.heading_offset))
        return Measurement(pose, captured_at, blob.centre, blob.corners, blob.area)
