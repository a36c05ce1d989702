"""What OpenCV is told by its environment: how it decodes and drives, and that it does so in silence.

Decoders and drivers speak to the terminal; what they have to say is told by whoever uses them, in words.
"""

DRIVER_PATIENCE = 1
"""A V4L driver that gives no picture for this long, s, is given up and opened anew (OpenCV's own is 10 s)."""

ENVIRONMENT = {
    "OPENCV_LOG_LEVEL": "SILENT",
    "OPENCV_FFMPEG_LOGLEVEL": "-8",  # FFmpeg's AV_LOG_QUIET
    "OPENCV_VIDEOIO_V4L_SELECT_TIMEOUT": str(DRIVER_PATIENCE),
    # The pictures are small: sharing their rows among threads costs more than it saves.
    "OPENCV_FOR_THREADS_NUM": "1",
}
"""Set when `vision` is first imported; OpenCV reads it when it is first used."""


def quieten() -> None:
    """Also where OpenCV was there before `vision`, and has read its own level of logging."""
    import cv2  # not above: whoever asks for an address or a name has no need to wait for it

    cv2.utils.logging.setLogLevel(cv2.utils.logging.LOG_LEVEL_SILENT)
