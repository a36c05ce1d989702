"""Draws what the rig knows over the camera's picture, for viewers that cannot draw it themselves (MJPEG)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np
from cv2.typing import MatLike
from numpy.typing import NDArray

from control.model import PIVOT_A, PIVOT_B, Observation, Pivot, Pose, Tracking, pivot_point
from vision.camera_model import CameraModel

# Okabe and Ito's palette, told apart with every kind of colour vision; BGR. Shapes differ as well.
REFERENCE = (233, 180, 86)
TRAIL = (0, 159, 230)
END_A = (178, 114, 0)
END_B = (0, 94, 213)
WINDOW = (66, 228, 240)
INK = (255, 255, 255)
EDGE = (0, 0, 0)

LABEL_DISTANCE = 18.0
"""From the end to the middle of its letter, px."""
SUBPIXEL_BITS = 4
"""Lines are drawn to a sixteenth of a pixel."""


@dataclass(frozen=True, slots=True)
class Drawing:
    """What to draw.

    length: between the robot's ends, m.  body_height: of its top surface above the plate, m.
    pivot: the active one.  reference, trail: paths (n, 2) on the plate, m.  target: the desired point, m.
    """

    length: float
    body_height: float
    pose: Pose | None = None
    pivot: Pivot = PIVOT_A
    observation: Observation | None = None
    reference: NDArray[np.float64] | None = None
    trail: NDArray[np.float64] | None = None
    target: tuple[float, float] | None = None


def draw_overlay(image: MatLike, camera_model: CameraModel, drawing: Drawing) -> MatLike:
    """A copy of the picture with paths, search window, robot axis and pivots on it."""
    canvas = image.copy()
    _path(canvas, camera_model, drawing.reference, REFERENCE)
    _path(canvas, camera_model, drawing.trail, TRAIL)
    if drawing.target is not None:
        centre = _fixed(camera_model.to_pixel(*drawing.target))
        cv2.circle(canvas, centre, 5 << SUBPIXEL_BITS, REFERENCE, 2, cv2.LINE_AA, SUBPIXEL_BITS)
    if drawing.observation is not None:
        _sighting(canvas, drawing.observation)
    if drawing.pose is not None and drawing.pose.is_finite:
        _robot(canvas, camera_model, drawing, drawing.pose)
    return canvas


def _fixed(point: tuple[float, float]) -> tuple[int, int]:
    u, v = point
    return round(u * (1 << SUBPIXEL_BITS)), round(v * (1 << SUBPIXEL_BITS))


def _path(
    canvas: MatLike, camera_model: CameraModel, points: NDArray | None, colour: tuple[int, int, int]
) -> None:
    if points is None:
        return
    finite = points[np.isfinite(points).all(axis=1)]
    if len(finite) > 1:
        fixed = np.rint(camera_model.to_image(finite) * (1 << SUBPIXEL_BITS)).astype(np.int32)
        cv2.polylines(canvas, [fixed], False, colour, 1, cv2.LINE_AA, SUBPIXEL_BITS)


def _sighting(canvas: MatLike, observation: Observation) -> None:
    """The search window, broken while the robot is not in sight, and the rectangle found."""
    u0, v0, u1, v1 = observation.window
    if observation.tracking is Tracking.LOCKED:
        cv2.rectangle(canvas, (u0, v0), (u1 - 1, v1 - 1), WINDOW, 1)
    else:
        _corners(canvas, u0, v0, u1 - 1, v1 - 1)
    if observation.measurement is not None:
        outline = np.array([_fixed(corner) for corner in observation.measurement.corners_image], np.int32)
        cv2.polylines(canvas, [outline], True, INK, 1, cv2.LINE_AA, SUBPIXEL_BITS)


def _corners(canvas: MatLike, u0: int, v0: int, u1: int, v1: int) -> None:
    arm = max((min(u1 - u0, v1 - v0)) // 4, 1)
    for u, v, du, dv in ((u0, v0, arm, arm), (u1, v0, -arm, arm), (u0, v1, arm, -arm), (u1, v1, -arm, -arm)):
        cv2.line(canvas, (u, v), (u + du, v), WINDOW, 1)
        cv2.line(canvas, (u, v), (u, v + dv), WINDOW, 1)


def _robot(canvas: MatLike, camera_model: CameraModel, drawing: Drawing, pose: Pose) -> None:
    end_a, end_b = (
        camera_model.to_pixel(*pivot_point(pose, end, drawing.length), drawing.body_height)
        for end in (PIVOT_A, PIVOT_B)
    )
    for colour, thickness in ((EDGE, 3), (INK, 1)):
        cv2.line(canvas, _fixed(end_b), _fixed(end_a), colour, thickness, cv2.LINE_AA, SUBPIXEL_BITS)
    _walking_direction(canvas, camera_model, drawing, pose)
    cv2.circle(canvas, _fixed(end_a), 4 << SUBPIXEL_BITS, END_A, cv2.FILLED, cv2.LINE_AA, SUBPIXEL_BITS)
    u, v = round(end_b[0]), round(end_b[1])
    cv2.rectangle(canvas, (u - 3, v - 3), (u + 3, v + 3), END_B, cv2.FILLED)
    active = end_a if drawing.pivot == PIVOT_A else end_b
    cv2.circle(canvas, _fixed(active), 8 << SUBPIXEL_BITS, INK, 1, cv2.LINE_AA, SUBPIXEL_BITS)
    _label(canvas, "A", end_a, end_b)
    _label(canvas, "B", end_b, end_a)


def _walking_direction(canvas: MatLike, camera_model: CameraModel, drawing: Drawing, pose: Pose) -> None:
    reach = 0.6 * drawing.length
    tip_x, tip_y = pose.x + reach * math.cos(pose.heading), pose.y + reach * math.sin(pose.heading)
    start, tip = (
        camera_model.to_pixel(x, y, drawing.body_height) for x, y in ((pose.x, pose.y), (tip_x, tip_y))
    )
    tail, head = ((round(u), round(v)) for u, v in (start, tip))
    cv2.arrowedLine(canvas, tail, head, INK, 1, cv2.LINE_AA, tipLength=0.35)


def _label(canvas: MatLike, text: str, end: tuple[float, float], other: tuple[float, float]) -> None:
    """Writes beyond the end, in line with the robot, so that the text hides nothing of it."""
    du, dv = end[0] - other[0], end[1] - other[1]
    share = LABEL_DISTANCE / max(math.hypot(du, dv), 1.0)
    place = round(end[0] + share * du) - 5, round(end[1] + share * dv) + 5
    for colour, thickness in ((EDGE, 3), (INK, 1)):
        cv2.putText(canvas, text, place, cv2.FONT_HERSHEY_SIMPLEX, 0.45, colour, thickness, cv2.LINE_AA)
