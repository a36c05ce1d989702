"""A video file, one frame after the other; a damaged part of it is left out."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from vision.sources.recorded import Still
from vision.sources.request import CameraError

LONGEST_DAMAGE = 300
"""So many attempts without a frame in a row are the end of a film, even if it says that it is longer: 10 s of film
at 30 frames/s. Each attempt gets past one broken packet."""
FASTEST = 1e4
"""A film that states more frames/s than this does not know."""


class VideoFile:
    """A film of `vision.sources.recorded`; raises `CameraError` when the file is none."""

    def __init__(self, path: Path) -> None:
        self.name = f"video file {path}"
        self.identity = f"file {path.name}"
        self.damaged = 0
        self._path = path
        self._capture = self._opened()
        self._length = self._capture.get(cv2.CAP_PROP_FRAME_COUNT)
        self.size = (
            int(self._capture.get(cv2.CAP_PROP_FRAME_WIDTH)),
            int(self._capture.get(cv2.CAP_PROP_FRAME_HEIGHT)),
        )
        self.rate = self._stated_rate()
        self._index = -1
        self._time = 0.0

    def advance(self) -> Still | None:
        attempts = 0
        while not self._capture.grab():
            attempts += 1
            if self._is_over or attempts >= LONGEST_DAMAGE:
                return None
        self.damaged += attempts
        self._index += 1
        self._time = self._stamp()
        return Still(self._time, self._index)

    def picture(self) -> NDArray[np.uint8] | None:
        done, image = self._capture.retrieve()
        if not done:
            self.damaged += 1
            return None
        return np.asarray(image, np.uint8)

    def rewind(self) -> None:
        """Opened anew: a decoder that met damage does not find its way back in every file."""
        self._capture.release()
        self._capture = self._opened()
        self._index, self._time = -1, 0.0

    def close(self) -> None:
        self._capture.release()

    @property
    def _is_over(self) -> bool:
        return self._capture.get(cv2.CAP_PROP_POS_FRAMES) >= self._length

    def _stamp(self) -> float:
        """When the frame is shown, s: as the file says where that makes sense, else by its number."""
        stated = self._capture.get(cv2.CAP_PROP_POS_MSEC) * 1e-3
        if self._index == 0:
            return 0.0
        earliest = self._time + 0.1 / self.rate
        return (
            stated
            if earliest <= stated <= self._time + LONGEST_DAMAGE / self.rate
            else self._time + 1.0 / self.rate
        )

    def _opened(self) -> cv2.VideoCapture:
        if not self._path.is_file():
            raise CameraError(
                f"{self.name} is missing, or no file; give its whole path, such as file:///home/me/x.mp4"
            )
        if self._path.stat().st_size == 0:
            raise CameraError(f"{self.name} is empty")
        # Only FFmpeg: OpenCV's other readers would take the name for a numbered series of pictures.
        capture = cv2.VideoCapture(str(self._path), cv2.CAP_FFMPEG)
        if not capture.isOpened():
            raise CameraError(
                f"{self.name} cannot be read: it is no video, of an unknown kind, or cut off before its index"
            )
        return capture

    def _stated_rate(self) -> float:
        rate = self._capture.get(cv2.CAP_PROP_FPS)
        if not 0.0 < rate <= FASTEST:
            raise CameraError(
                f"{self.name} states {rate} frames/s; allowed are rates above 0, up to {FASTEST:g}"
            )
        return rate
