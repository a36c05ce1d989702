"""USB and other cameras of this computer, through Video4Linux."""

from __future__ import annotations

import errno
import grp
import os
import stat
import time
from collections.abc import Iterable
from pathlib import Path

import cv2
import numpy as np

from vision.sources import controls, v4l_ioctl
from vision.sources.listing import identity_of
from vision.sources.live import Picture
from vision.sources.request import CameraError, CameraRequest, Size, in_words

BUFFERS = 3
"""One that we decode, one that the driver fills, one between; with fewer, a camera loses pictures meanwhile."""
LONGEST_BUFFERED = 2.0
"""A driver whose first times lie further back, s, goes by another clock than the monotonic one."""
SAME_RATE = 0.01
"""Share by which two rates may differ and count as the same: cameras offer 29.97 for 30."""
RAW, COMPRESSED = "YUYV", "MJPG"


class V4lCamera:
    """A source of `vision.sources.live`. ignored: settings that its driver has not taken."""

    def __init__(self, device: Path, request: CameraRequest) -> None:
        self._name = str(device)
        check(device)
        self.identity = identity_of(device)
        self._clock = DriverClock()
        self._capture = cv2.VideoCapture(self._name, cv2.CAP_V4L2)
        if not self._capture.isOpened():
            raise CameraError(
                f"camera {device} cannot be opened: it gives no pictures, or another program uses it"
            )
        try:
            self.ignored = self._configure(device, request)
        except BaseException:
            self._capture.release()
            raise

    def read(self) -> Picture | None:
        if not self._capture.grab():
            raise CameraError(f"camera {self._name} gives no pictures any more: was it unplugged?")
        captured_at = self._clock.capture_time(
            self._capture.get(cv2.CAP_PROP_POS_MSEC) * 1e-3, time.monotonic()
        )
        done, image = self._capture.retrieve()
        return Picture(np.asarray(image, np.uint8), captured_at) if done else None

    def close(self) -> None:
        self._capture.release()

    def _configure(self, device: Path, request: CameraRequest) -> tuple[str, ...]:
        with v4l_ioctl.opened(device) as descriptor:
            offered = v4l_ioctl.modes(descriptor)
            self._set_format(request, offered)
            self.size = self._get_size()
            if self.size != request.size:
                raise CameraError(_other_size(device, self.size, request.size, offered))
            ignored = controls.apply(descriptor, request)
        return (*self._other_rate(request.rate, offered), *ignored)

    def _set_format(self, request: CameraRequest, offered: Iterable[v4l_ioctl.Mode]) -> None:
        letters = pixel_format(offered, request.size, request.rate)
        self._capture.set(cv2.CAP_PROP_FOURCC, cv2.VideoWriter.fourcc(*letters))
        self._capture.set(cv2.CAP_PROP_FRAME_WIDTH, request.size[0])
        self._capture.set(cv2.CAP_PROP_FRAME_HEIGHT, request.size[1])
        self._capture.set(cv2.CAP_PROP_BUFFERSIZE, BUFFERS)
        self._capture.set(cv2.CAP_PROP_FPS, request.rate)

    def _get_size(self) -> Size:
        width, height = cv2.CAP_PROP_FRAME_WIDTH, cv2.CAP_PROP_FRAME_HEIGHT
        return int(self._capture.get(width)), int(self._capture.get(height))

    def _other_rate(self, asked: float, offered: Iterable[v4l_ioctl.Mode]) -> tuple[str, ...]:
        got = self._capture.get(cv2.CAP_PROP_FPS)
        if abs(got - asked) <= SAME_RATE * asked:
            return ()
        rates = sorted({rate for mode in offered if mode.size == self.size for rate in mode.rates})
        offers = f"; it offers {', '.join(f'{rate:g}' for rate in rates)}" if rates else ""
        return (f"rate_Hz = {asked:g} was asked, and the camera has {got:g}{offers}",)


class DriverClock:
    """Tells by which clock a driver stamps its buffers: the monotonic one for USB cameras
    (V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC), but some drivers give the time of day, or none."""

    def __init__(self) -> None:
        self._is_monotonic = False

    def capture_time(self, stamp: float, grabbed_at: float) -> float:
        """When the picture was taken, monotonic s: by the driver's stamp, which lies before the frame's journey
        through buffers and decoder, where it can be that; else when it was grabbed.

        A driver that was once right is believed however old its picture is: buffers keep theirs as long as nobody
        fetches them. stamp: of the buffer, s.
        """
        age = grabbed_at - stamp
        self._is_monotonic = self._is_monotonic or 0.0 <= age <= LONGEST_BUFFERED
        return stamp if self._is_monotonic and stamp > 0.0 and age >= 0.0 else grabbed_at


def pixel_format(offered: Iterable[v4l_ioctl.Mode], size: Size, rate: float) -> str:
    """Raw pictures where the camera gives them fast enough: compression smears the colour of a small robot."""
    fast_enough = (
        mode.fourcc == RAW and mode.size == size and max(mode.rates, default=0.0) >= (1.0 - SAME_RATE) * rate
        for mode in offered
    )
    return RAW if any(fast_enough) else COMPRESSED


def check(device: Path) -> None:
    """Raises `CameraError` with the reason for which this device cannot be opened."""
    try:
        node = os.stat(device)
    except OSError as error:
        raise CameraError(f"camera {device} is not plugged in ({error.strerror})") from error
    if not stat.S_ISCHR(node.st_mode):
        raise CameraError(f"{device} is no camera; `pivotrig doctor` lists those that are there")
    try:
        with v4l_ioctl.opened(device) as descriptor:
            usable = v4l_ioctl.gives_pictures(descriptor)
    except PermissionError as error:
        raise CameraError(_forbidden(device, node.st_gid)) from error
    except OSError as error:
        is_gone = error.errno in (errno.ENODEV, errno.ENXIO, errno.ENOENT)
        what = "is not plugged in" if is_gone else "cannot be opened"
        raise CameraError(f"camera {device} {what} ({error.strerror})") from error
    if not usable:
        raise CameraError(f"{device} gives no pictures (a camera has other nodes too); take its first one")


def _forbidden(device: Path, gid: int) -> str:
    try:
        group = grp.getgrgid(gid).gr_name
    except KeyError:
        group = "video"
    return (
        f"camera {device} may not be opened: it belongs to the group {group}. Run `sudo usermod -aG {group} $USER`, "
        "then log out and in again"
    )


def _other_size(device: Path, got: Size, asked: Size, offered: Iterable[v4l_ioctl.Mode]) -> str:
    sizes = sorted({mode.size for mode in offered})
    offers = f": {', '.join(map(in_words, sizes))}" if sizes else ""
    return (
        f"camera {device} gives {in_words(got)} where {in_words(asked)} was asked; "
        f"set camera.size_px to a size that it offers{offers}"
    )
