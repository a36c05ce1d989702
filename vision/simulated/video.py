"""Writes scenes to video files, with the truth beside them."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import cv2

from control.model import Body
from vision.simulated.scenes import Shown

CODECS = {".avi": "MJPG", ".mp4": "mp4v"}
"""What OpenCV writes without further libraries; the first has one JPEG a frame, the second predicts from frame to
frame."""
MM = 1e-3


class VideoError(ValueError):
    """A video that cannot be written; the text says why and what can be."""


@dataclass(frozen=True, slots=True)
class Truth:
    """Of one picture: time of its mid-exposure, s; the robot then; and its visible share, 0..1."""

    time: float
    body: Body | None
    visible: float


def write_video(path: Path, shown: Iterable[Shown], rate: float, codec: str | None = None) -> list[Truth]:
    """Write the pictures to `path` and the truth to the file beside it that ends with .truth.json; returns the truth.

    rate: frames/s.  codec: four letters; without them the usual one for the file's ending.  Raises `VideoError`.
    """
    codec = codec or _codec_for(path)
    truth: list[Truth] = []
    writer = cv2.VideoWriter()
    try:
        for one in shown:
            if not truth:
                _open(writer, path, codec, rate, one)
            writer.write(one.frame.image)
            truth.append(Truth(one.frame.captured_at, one.body, one.visible))
    finally:
        writer.release()
    if not truth:
        raise VideoError(f"no picture came for {path}; a video needs one at least")
    truth_beside(path).write_text(json.dumps([_as_json(one) for one in truth]), encoding="utf-8")
    return truth


def truth_beside(path: Path) -> Path:
    """Where the truth of a video is: a list of objects, one a frame, in mm and degrees; without a robot null."""
    return path.with_suffix(path.suffix + ".truth.json")


def _codec_for(path: Path) -> str:
    codec = CODECS.get(path.suffix.lower())
    if codec is None:
        raise VideoError(
            f"a video is written to a file ending with {' or '.join(CODECS)}, not to {path.name!r}"
        )
    return codec


def _open(writer: cv2.VideoWriter, path: Path, codec: str, rate: float, first: Shown) -> None:
    height, width = first.frame.image.shape[:2]
    if not writer.open(str(path), cv2.VideoWriter.fourcc(*codec), rate, (width, height)):
        raise VideoError(f"OpenCV cannot write {path} as {codec!r} at {rate} Hz, {width} x {height} px")


def _as_json(one: Truth) -> dict[str, object]:
    body = one.body
    truth = None
    if body is not None:
        truth = {
            "x_mm": body.pose.x / MM,
            "y_mm": body.pose.y / MM,
            "heading_deg": math.degrees(body.pose.heading),
            "pivot": body.pivot,
            "tilt_deg": math.degrees(body.tilt),
        }
    return {"time_s": one.time, "visible": one.visible, "body": truth}
