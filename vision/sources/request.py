"""What is asked of a camera, and how one that cannot be used says so."""

from __future__ import annotations

from dataclasses import dataclass

Size = tuple[int, int]
"""Width and height of a picture, px."""

ALLOWED = (
    "v4l://0 (a camera's number), v4l:///dev/video0 or v4l:///dev/v4l/by-id/NAME (its path), rtsp://HOST/PATH, "
    "http://HOST/PATH, file:///path/to/video.mp4 or folder:///path/to/pictures"
)


class CameraError(RuntimeError):
    """A camera that cannot be used; the text says what was asked, what is allowed and what to do."""


@dataclass(frozen=True, slots=True)
class CameraRequest:
    """What a camera shall do; None leaves a setting to the camera's own automatic.

    size: of the pictures, px.  rate: frames/s.  exposure: s.  gain: in the driver's own steps.
    white_balance: colour temperature, K.
    latency: from mid-exposure to the time that the driver or the arrival tells, s; subtracted from each stamp.
    """

    size: Size = (640, 480)
    rate: float = 60.0
    exposure: float | None = None
    gain: float | None = None
    white_balance: float | None = None
    latency: float = 0.0


def in_words(size: Size) -> str:
    """A size as the messages write it."""
    return f"{size[0]}x{size[1]} px"
