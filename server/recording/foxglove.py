"""The message types that Foxglove knows by name (https://docs.foxglove.dev/docs/sdk/schemas), with our tick beside.

They are in SI, as their own definition says; `timestamp` is UTC.
"""

from __future__ import annotations

from typing import Annotated

from server.recording.messages import OfTick, Part, Triple
from server.recording.schemas import quantity

WORKSPACE_FRAME = "workspace"
CAMERA_FRAME = "camera"
LEVELS = {"info": 2, "warn": 3, "error": 4}
"""Foxglove's numbers of the severities; 0 is unknown."""
NANO = 1_000_000_000


class Time(Part, frozen=True, kw_only=True):
    """An instant, UTC."""

    sec: Annotated[int, quantity("seconds since 1970", "s")]
    nsec: Annotated[int, quantity("and nanoseconds", "ns")]


class Vector3(Part, frozen=True, kw_only=True):
    """A point or a direction."""

    x: Annotated[float, quantity("to the right in the picture", "m")]
    y: Annotated[float, quantity("up in the picture", "m")]
    z: Annotated[float, quantity("up from the plate", "m")]


class Quaternion(Part, frozen=True, kw_only=True):
    """An orientation."""

    x: Annotated[float, quantity("x")]
    y: Annotated[float, quantity("y")]
    z: Annotated[float, quantity("z")]
    w: Annotated[float, quantity("w")]


class Pose(Part, frozen=True, kw_only=True):
    """Place and orientation."""

    position: Annotated[Vector3, quantity("the robot's centre", "m")]
    orientation: Annotated[Quaternion, quantity("its x axis is the direction of walking")]


class PoseInFrame(OfTick, frozen=True, kw_only=True):
    """The estimated pose of the robot."""

    timestamp: Annotated[Time, quantity("of the tick")]
    frame_id: Annotated[str, quantity("the frame of reference")]
    pose: Annotated[Pose, quantity("the robot's pose")]


class Log(OfTick, frozen=True, kw_only=True):
    """A line of the event log."""

    timestamp: Annotated[Time, quantity("when it happened")]
    level: Annotated[int, quantity("2 info, 3 warning, 4 error")]
    message: Annotated[str, quantity("what happened, in words")]
    name: Annotated[str, quantity("short name of what happened")]
    file: Annotated[str, quantity("not used")]
    line: Annotated[int, quantity("not used")]


class CompressedImage(OfTick, frozen=True, kw_only=True):
    """A camera picture."""

    timestamp: Annotated[Time, quantity("when it was captured: mid-exposure")]
    frame_id: Annotated[str, quantity("the frame of reference")]
    format: Annotated[str, quantity("jpeg")]
    captured_s: Annotated[float, quantity("when it was captured, rig time", "s")]
    frame: Annotated[int, quantity("number of the picture, gaps are drops")]
    data: Annotated[bytes, quantity("the JPEG")]


class CameraCalibration(OfTick, frozen=True, kw_only=True):
    """Lens of the camera: a pinhole with the Brown-Conrady model."""

    timestamp: Annotated[Time, quantity("of the run's start")]
    frame_id: Annotated[str, quantity("the frame of reference")]
    width: Annotated[int, quantity("of the picture", "px")]
    height: Annotated[int, quantity("of the picture", "px")]
    distortion_model: Annotated[str, quantity("plumb_bob: k1, k2, p1, p2, k3")]
    D: Annotated[Triple, quantity("distortion")]
    K: Annotated[Triple, quantity("camera matrix, row by row", "px", 9)]
    R: Annotated[Triple, quantity("rectification, row by row", length=9)]
    P: Annotated[Triple, quantity("projection, row by row", "px", 12)]


def time_of(nanoseconds: int) -> Time:
    """UTC since 1970, ns."""
    sec, nsec = divmod(nanoseconds, NANO)
    return Time(sec=sec, nsec=nsec)
