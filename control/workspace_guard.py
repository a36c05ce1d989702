"""How near the edge of the workspace the robot may be driven: soft and hard margin, stopping distance; pure.

It is the robot's centre that counts, in a square about the coils' centre: paths are paths of the centre, and
what is allowed is a path. Its ends reach half a body further, where the coil map still holds.
"""

from __future__ import annotations

import math

from control.model import Pivot, Pose, swing

TOLERANCE = 1e-4
"""Motion outward that is none, m: the sway of a sweep of 10 degrees (0.08 mm at 10 mm between the pivots), and
more than twice the noise of the estimate."""
ARC_STEP = math.radians(8.0)
"""An arc is looked at this often; between two looks it bulges by 0.012 mm at 10 mm between the pivots."""
LONGEST_ARC = math.radians(360.0)
"""After a turn the centre has been everywhere on its circle."""


def reach(pose: Pose) -> float:
    """How far out the centre is, m: the half side of the square that it lies on; inf for a pose that is none."""
    return max(abs(pose.x), abs(pose.y)) if pose.is_finite else math.inf


def arc_to_stop(rate: float, left: float, stopping_time: float) -> float:
    """The angle (rad, signed) that the body still makes once the coils are told to stop now.

    rate: of the field, rad/s.  left: from the body's heading to the field's goal, rad.  stopping_time: s.
    NaN where rate or goal are not finite.
    """
    if not (math.isfinite(rate) and math.isfinite(left)):
        return math.nan
    if left * rate <= 0.0:
        return 0.0
    return math.copysign(min(abs(left), abs(rate) * stopping_time), rate)


def farthest(pose: Pose, pivot: Pivot, arc: float, length: float) -> float:
    """How far out this arc (rad) about this pivot takes the centre, m; inf for what is not finite.

    length: between the pivots, m.
    """
    if not (pose.is_finite and math.isfinite(arc)):
        return math.inf
    arc = max(-LONGEST_ARC, min(LONGEST_ARC, arc))
    looks = max(1, math.ceil(abs(arc) / ARC_STEP))
    return max(reach(swing(pose, pivot, arc * (look + 1) / looks, length)) for look in range(looks))


class WayBack:
    """A margin that lets a robot beyond it move inward: what holds for that robot only ever shrinks."""

    def __init__(self, margin: float) -> None:
        """margin: half side of the square, m."""
        self._margin = margin
        self.limit = margin

    def open(self, pose: Pose) -> None:
        """The operator goes on from here, deliberately."""
        self.limit = max(self._margin, reach(pose) + TOLERANCE) if pose.is_finite else self._margin

    def follow(self, pose: Pose | None) -> None:
        """The robot is here now: what it has come inward is not given back."""
        if pose is not None and pose.is_finite:
            self.limit = max(self._margin, min(self.limit, reach(pose) + TOLERANCE))

    def close(self) -> None:
        """The coils are off: the margin itself holds again."""
        self.limit = self._margin


class WorkspaceGuard:
    """Both margins of one rig; all methods take the robot's pose as it is estimated now."""

    def __init__(self, soft: float, hard: float, length: float) -> None:
        """soft, hard: half sides of the squares, m.  length: between the pivots, m."""
        if not (0.0 < soft <= hard < math.inf and 0.0 < length < math.inf):
            raise ValueError(
                "the margins need 0 < soft <= hard and a length above 0, all finite, in m; "
                f"got soft {soft!r}, hard {hard!r}, length {length!r}"
            )
        self._soft = WayBack(soft)
        self._hard = WayBack(hard)
        self._length = length

    @property
    def soft_limit(self) -> float:
        """No command may lead further out than this now, m."""
        return self._soft.limit

    @property
    def hard_limit(self) -> float:
        """Further out than this the coils are switched off now, m."""
        return self._hard.limit

    def energised(self, pose: Pose) -> None:
        """The coils come on: from beyond the soft margin it goes inward."""
        self._soft.open(pose)

    def resumed(self, pose: Pose) -> None:
        """The operator goes on after a hold: from beyond the hard margin too it goes inward."""
        self._soft.open(pose)
        self._hard.open(pose)

    def follow(self, pose: Pose | None) -> None:
        """The robot is here now."""
        self._soft.follow(pose)
        self._hard.follow(pose)

    def rest(self) -> None:
        """The coils are off."""
        self._soft.close()
        self._hard.close()

    def leads_out(self, pose: Pose, pivot: Pivot, arc: float) -> bool:
        """Whether this arc (rad) about this pivot leads out of the soft margin, or further out beyond it."""
        allowed = max(self._soft.limit, reach(pose))
        return not farthest(pose, pivot, arc, self._length) <= allowed < math.inf
