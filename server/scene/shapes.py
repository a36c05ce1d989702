"""The geometry of what the scene shows, as arrays in m; nothing here knows Viser."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from control.coils import CoilPair, CoilSet
from control.model import Pivot, Pose, pivot_point
from control.snapshot import Vector

Floats = NDArray[np.float64]

RING_SEGMENTS = 96
GRID = 7
"""Arrows along each side of the workspace: 49 in all, which a browser draws in software at 10 a second."""
ARROW_HEIGHT = 0.004
"""The arrows' height above the plate, m: just over the robot."""
ABOVE_ROBOT = 0.008
"""Height of the one arrow at the robot, m: clear of its raised end."""
SCALES_mT = (1, 2, 3, 4, 5, 6, 8, 10, 12, 15, 20, 25, 30, 40, 50, 60)
"""Ends of the field's scale that there are, so that it seldom changes and reads well."""
RESERVE = 1.2
"""The field at the workspace's rim over the gait's, which holds where the robot is."""
FULL_FIELD = 0.012
"""End of the scale where no gait is known, T: that of the paper's 10 mT."""
ARROW_LENGTH = 0.016
"""Length of an arrow at the scale's end, m: shorter than the grid's 20 mm."""
VISIBLE_FIELD = 5e-5
"""Below this the field is not drawn, T: the earth's."""

CIVIDIS = np.array(
    [[0, 34, 78], [53, 69, 108], [102, 105, 112], [148, 142, 119], [200, 184, 102], [254, 232, 56]],
    dtype=float,
)
"""Anchors of the cividis colour map, which reads alike with and without colour blindness. The page's legend has the
same ones."""


def ring_segments(pair: CoilPair) -> Floats:
    """Both loops of a pair as line segments (n, 2, 3)."""
    turn = np.linspace(0.0, 2.0 * math.pi, RING_SEGMENTS + 1)
    across, along = 0.5 * pair.diameter * np.cos(turn), 0.5 * pair.diameter * np.sin(turn)
    axis = "xyz".index(pair.axis)
    loops = []
    for centre in pair.centres:
        points = np.tile(np.array(centre), (len(turn), 1))
        points[:, (axis + 1) % 3] += across
        points[:, (axis + 2) % 3] += along
        loops.append(np.stack([points[:-1], points[1:]], axis=1))
    return np.concatenate(loops)


def square(half: float, height: float) -> Floats:
    """The four sides of a square as segments (4, 2, 3), in the unit of its arguments."""
    corners = np.array([[-half, -half], [half, -half], [half, half], [-half, half], [-half, -half]])
    return segments_through(corners, height, len(corners))


def segments_through(points: Floats, height: float, longest: int) -> Floats:
    """Points (n, 2) as segments (m, 2, 3) at `height`; thinned to `longest` points, its end kept."""
    if len(points) < 2:
        return np.zeros((0, 2, 3))
    if len(points) > longest:
        points = points[np.linspace(0, len(points) - 1, longest).round().astype(int)]
    raised = np.column_stack([points, np.full(len(points), height)])
    return np.stack([raised[:-1], raised[1:]], axis=1)


def body_attitude(
    pose: Pose, pivot: Pivot, tilt: float, length: float, height: float
) -> tuple[Vector, tuple[float, float, float, float]]:
    """Centre (m) and quaternion (w, x, y, z) of the body that stands on its pivot with the other end raised.

    The body's local x is the direction of walking and its local y the long axis B -> A. The pressed end
    stays on the plate, so the centre comes nearer to it and rises as the body tilts (rad).
    """
    x, y = pivot_point(pose, pivot, length)
    back = -pivot * 0.5 * length
    lift = -pivot * tilt
    above, level = 0.5 * height * math.cos(lift), back * math.cos(lift) - 0.5 * height * math.sin(lift)
    centre = (
        x - level * math.sin(pose.heading),
        y + level * math.cos(pose.heading),
        back * math.sin(lift) + above,
    )
    return centre, turn_then_lift(pose.heading, lift)


def turn_then_lift(heading: float, lift: float) -> tuple[float, float, float, float]:
    """Quaternion of a turn by `heading` about z after a lift of the local y axis by `lift`, rad."""
    cz, sz = math.cos(0.5 * heading), math.sin(0.5 * heading)
    cx, sx = math.cos(0.5 * lift), math.sin(0.5 * lift)
    return cz * cx, cz * sx, sz * sx, sz * cx


class FieldArrows:
    """The field on a grid over the plate.

    The field is linear in the currents, so the grid's field per ampere is worked out once.
    """

    def __init__(self, coils: CoilSet, workspace: float) -> None:
        steps = np.linspace(-workspace, workspace, GRID)
        x, y = np.meshgrid(steps, steps)
        self.origins: Floats = np.column_stack([x.ravel(), y.ravel(), np.full(x.size, ARROW_HEIGHT)])
        self._per_ampere: Floats = coils.field_per_ampere(self.origins)

    def field(self, currents: Vector) -> Floats:
        """Field (n, 3) T at the origins."""
        return self._per_ampere @ np.asarray(currents)


def full_field(gait_field: float) -> float:
    """End of the field's scale (T) for a gait of this field (T)."""
    needed = RESERVE * gait_field * 1e3 - 1e-9
    return next((scale for scale in SCALES_mT if scale >= needed), SCALES_mT[-1]) * 1e-3


def is_visible(field: Floats) -> bool:
    """Whether a field (n, 3) T is more than the earth's anywhere."""
    return bool(np.linalg.norm(field, axis=1).max() > VISIBLE_FIELD)


def arrows_of(field: Floats, origins: Floats, full_field: float) -> tuple[Floats, NDArray[np.uint8]]:
    """Arrows (n, 2, 3) m, centred on their origins, of a field (n, 3) T, and their colours (n, 3)."""
    half = 0.5 * ARROW_LENGTH / full_field * field
    half[:, 2] += 1e-6  # a direction also where there is no field
    strength = np.linalg.norm(field, axis=1) / full_field
    return np.stack([origins - half, origins + half], axis=1), colours(strength)


def colours(share: Floats) -> NDArray[np.uint8]:
    """Colours (n, 3) for shares 0..1 of the scale."""
    places = np.linspace(0.0, 1.0, len(CIVIDIS))
    channels = [np.interp(share, places, CIVIDIS[:, channel]) for channel in range(3)]
    return np.stack(channels, axis=1).round().astype(np.uint8)
