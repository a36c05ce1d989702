"""Decoders and drivers speak to the terminal; what they have to say is told by whoever uses them, in words."""

from __future__ import annotations

import os

import cv2

DRIVER_PATIENCE = 1
"""A V4L driver that gives no picture for this long, s, is given up and opened anew (OpenCV's own is 10 s)."""

_SETTINGS = {
    "OPENCV_FFMPEG_LOGLEVEL": "-8",  # FFmpeg's AV_LOG_QUIET
    "OPENCV_VIDEOIO_V4L_SELECT_TIMEOUT": str(DRIVER_PATIENCE),
}


def quieten() -> None:
    """To be called before the first film is opened or written; what somebody has set in the environment counts."""
    for name, value in _SETTINGS.items():
        os.environ.setdefault(name, value)
    cv2.utils.logging.setLogLevel(cv2.utils.logging.LOG_LEVEL_SILENT)
