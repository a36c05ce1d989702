"""Opens a camera by its URI: a V4L/UVC camera or a video file. (`sim://` is put together with its world.)"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Protocol
from urllib.parse import unquote, urlsplit

import cv2
import numpy as np
from cv2.typing import MatLike

from control.model import Frame

ALLOWED = "v4l://0 (a camera's number), v4l:///dev/video0 (its path) or file:///path/to/video.mp4"
FIRST_BACK_OFF = 0.2
LONGEST_BACK_OFF = 2.0
"""Waits between attempts to open a camera that went away, s; each is twice the one before."""
CLOSING_TIME = 2.0
"""A reader that is inside the driver gets this long to come back, s."""

Size = tuple[int, int]
Opener = Callable[[], cv2.VideoCapture]


class CameraError(RuntimeError):
    """A camera that cannot be used; the text says what was asked, what is allowed and what to do."""


class Camera(Protocol):
    """What the loop reads; the loop's own protocol says the same."""

    simulated: bool
    size: Size
    rate: float

    def read(self, timeout: float) -> Frame | None: ...
    def now(self) -> float: ...
    def close(self) -> None: ...


def open_camera(uri: str, size: Size = (640, 480), rate: float = 60.0) -> Camera:
    """The camera behind a URI.

    size: (width, height) px and rate: frames/s are asked of a camera; a file brings its own rate.
    Raises CameraError when the URI is not understood or the camera is not there.
    """
    parts = urlsplit(uri)
    match parts.scheme:
        case "v4l":
            return DeviceCamera(_device(uri, parts.netloc, parts.path, size, rate), uri, size, rate)
        case "file":
            return FileCamera(Path(unquote(parts.path)))
        case "sim":
            raise CameraError(f"{uri} is the simulated camera; it comes with its world, not as a device")
        case _:
            raise CameraError(f"camera {uri!r} is not understood; allowed are {ALLOWED}")


def _device(uri: str, number: str, path: str, size: Size, rate: float) -> Opener:
    if not (number.isdecimal() and not path) and not (not number and path.startswith("/dev/")):
        raise CameraError(f"camera {uri!r} names neither a number nor a path; allowed are {ALLOWED}")
    source = int(number) if number else path

    def opener() -> cv2.VideoCapture:
        capture = cv2.VideoCapture(source, cv2.CAP_V4L2)
        capture.set(cv2.CAP_PROP_FOURCC, cv2.VideoWriter.fourcc(*"MJPG"))
        capture.set(cv2.CAP_PROP_FRAME_WIDTH, size[0])
        capture.set(cv2.CAP_PROP_FRAME_HEIGHT, size[1])
        capture.set(cv2.CAP_PROP_FPS, rate)
        capture.set(cv2.CAP_PROP_BUFFERSIZE, 1)
        return capture

    return opener


def _size_of(capture: cv2.VideoCapture) -> Size:
    return int(capture.get(cv2.CAP_PROP_FRAME_WIDTH)), int(capture.get(cv2.CAP_PROP_FRAME_HEIGHT))


class DeviceCamera:
    """A camera that is read by a thread of its own, which keeps the newest frame only.

    A camera that goes away is opened again with growing waits; until then `read` returns None.
    """

    simulated = False

    def __init__(self, opener: Opener, name: str, size: Size, rate: float) -> None:
        self.size = size
        self.rate = rate
        self._opener = opener
        self._name = name
        self._newest: Frame | None = None
        self._arrival = threading.Condition()
        self._closing = threading.Event()
        capture = self._open_first()
        self._reader = threading.Thread(target=self._run, args=(capture,), name="camera", daemon=True)
        self._reader.start()

    def now(self) -> float:
        return time.monotonic()

    def read(self, timeout: float) -> Frame | None:
        """The newest frame that has not been read yet; None when none came within `timeout`, s."""
        with self._arrival:
            self._arrival.wait_for(lambda: self._newest is not None or self._closing.is_set(), timeout)
            frame, self._newest = self._newest, None
        return None if self._closing.is_set() else frame

    def close(self) -> None:
        self._closing.set()
        with self._arrival:
            self._arrival.notify_all()
        self._reader.join(CLOSING_TIME)

    def _open_first(self) -> cv2.VideoCapture:
        capture = self._opener()
        if not capture.isOpened():
            raise CameraError(
                f"camera {self._name} cannot be opened: not plugged in, in use, or no permission "
                "(try another number, or add yourself to the group video)"
            )
        if (size := _size_of(capture)) != self.size:
            capture.release()
            raise CameraError(
                f"camera {self._name} gives {size[0]}x{size[1]} px where {self.size[0]}x{self.size[1]} px "
                "was asked; set camera.size_px to a size that it offers"
            )
        return capture

    def _run(self, capture: cv2.VideoCapture) -> None:
        index, back_off = 0, FIRST_BACK_OFF
        while not self._closing.is_set():
            if not capture.grab():
                capture.release()
                self._closing.wait(back_off)
                back_off = min(2.0 * back_off, LONGEST_BACK_OFF)
                capture = self._opener()
                continue
            captured_at = time.monotonic()
            done, image = capture.retrieve()
            if done:
                self._deliver(image, captured_at, index)
                index, back_off = index + 1, FIRST_BACK_OFF
        capture.release()

    def _deliver(self, image: MatLike, captured_at: float, index: int) -> None:
        with self._arrival:
            self._newest = Frame(np.asarray(image, np.uint8), captured_at, index)
            self._arrival.notify_all()


class FileCamera:
    """A video file at its own pace; frames whose time has passed are left out, as by a camera."""

    simulated = False

    def __init__(self, path: Path) -> None:
        self._capture = cv2.VideoCapture(str(path))
        if not self._capture.isOpened():
            raise CameraError(f"video file {path} cannot be read: it is missing or of an unknown kind")
        self.size = _size_of(self._capture)
        self.rate = self._capture.get(cv2.CAP_PROP_FPS)
        if not 0.0 < self.rate < 1e4:
            raise CameraError(f"video file {path} states {self.rate} frames/s; it must be above 0")
        self._next_index = 0
        self._start = math.nan
        self._closing = threading.Event()

    def now(self) -> float:
        return time.monotonic()

    def read(self, timeout: float) -> Frame | None:
        """The next frame at its time; None when that is further off than `timeout`, s, or at the end."""
        now = time.monotonic()
        if math.isnan(self._start):
            self._start = now
        if not self._skip_to(now):
            self._closing.wait(timeout)
            return None
        due = self._start + self._next_index / self.rate
        self._closing.wait(max(0.0, min(due - now, timeout)))
        if due > now + timeout or self._closing.is_set():
            return None
        return self._next(due)

    def close(self) -> None:
        self._closing.set()
        self._capture.release()

    def _skip_to(self, now: float) -> bool:
        """Leaves out each frame whose successor is due; False when the file has ended."""
        while (now - self._start) * self.rate >= self._next_index + 1:
            if not self._capture.grab():
                return False
            self._next_index += 1
        return True

    def _next(self, due: float) -> Frame | None:
        done, image = self._capture.read()
        if not done:
            return None
        self._next_index += 1
        return Frame(np.asarray(image, np.uint8), due, self._next_index - 1)
