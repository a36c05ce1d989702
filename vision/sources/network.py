"""Network cameras: RTSP, MJPEG over HTTP, and whatever else FFmpeg understands behind an address."""

from __future__ import annotations

import time

import cv2
import numpy as np

from vision.sources.addresses import public, shown, split
from vision.sources.live import Picture
from vision.sources.request import CameraError

OPEN_TIMEOUT = 3.0
"""An address that does not answer for this long, s, is tried again later."""
READ_TIMEOUT = 1.0
"""A stream that says nothing for this long, s, is given up and opened anew."""


class Stream:
    """A source of `vision.sources.live`. The network tells no capture times: a picture's is that of its arrival."""

    ignored: tuple[str, ...] = ()

    def __init__(self, uri: str) -> None:
        self.identity = public(uri)
        self._name = shown(uri)
        self._capture = _opened(uri)
        self.size = (
            int(self._capture.get(cv2.CAP_PROP_FRAME_WIDTH)),
            int(self._capture.get(cv2.CAP_PROP_FRAME_HEIGHT)),
        )

    def read(self) -> Picture | None:
        if not self._capture.grab():
            raise CameraError(f"the stream of camera {self._name} has broken off, or sends nothing any more")
        arrived_at = time.monotonic()
        done, image = self._capture.retrieve()
        return Picture(np.asarray(image, np.uint8), arrived_at) if done else None

    def close(self) -> None:
        self._capture.release()


def check(uri: str) -> None:
    """Raises `CameraError` for an address without a host."""
    if not split(uri).hostname:
        raise CameraError(
            f"camera {shown(uri)!r} names no host; allowed is for example rtsp://192.168.1.20:554/stream"
        )


def _opened(uri: str) -> cv2.VideoCapture:
    """Decoded by one thread: FFmpeg's several would hold back a frame each."""
    options = {
        cv2.CAP_PROP_OPEN_TIMEOUT_MSEC: round(OPEN_TIMEOUT * 1e3),
        cv2.CAP_PROP_READ_TIMEOUT_MSEC: round(READ_TIMEOUT * 1e3),
        cv2.CAP_PROP_N_THREADS: 1,
    }
    capture = cv2.VideoCapture(
        uri, cv2.CAP_FFMPEG, [number for option in options.items() for number in option]
    )
    if not capture.isOpened():
        raise CameraError(
            f"camera {shown(uri)} does not answer with a video stream: check its address, user and password, "
            "and that it is switched on"
        )
    return capture
