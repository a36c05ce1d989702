"""Opens a camera by its URI. (`sim://` is put together with its world.)"""

from __future__ import annotations

from functools import partial
from typing import Protocol

from control.model import CameraNote, Frame
from vision.sources import network
from vision.sources.addresses import NETWORK, device_of, playback_of, shown, split
from vision.sources.decoders import quieten
from vision.sources.image_folder import ImageFolder
from vision.sources.live import LiveCamera
from vision.sources.recorded import RecordedCamera
from vision.sources.request import ALLOWED, CameraError, CameraRequest, Size
from vision.sources.v4l import V4lCamera
from vision.sources.video_file import VideoFile

__all__ = ["Camera", "CameraError", "CameraRequest", "open_camera"]

quieten()


class Camera(Protocol):
    """What the loop reads; the loop's own protocol says the same, and what each part of it means."""

    simulated: bool
    size: Size
    rate: float

    @property
    def identity(self) -> str: ...
    @property
    def trouble(self) -> str: ...
    def require(self) -> None: ...
    def read(self, timeout: float) -> Frame | None: ...
    def now(self) -> float: ...
    def take_notes(self) -> list[CameraNote]: ...
    def close(self) -> None: ...


def open_camera(uri: str, request: CameraRequest | None = None) -> Camera:
    """The camera behind a URI; a recording brings its own size and rate.

    A camera is opened in the background, for it may be plugged in later: `require` waits for it, and says what is
    in the way. Raises `CameraError` when the URI is not understood, or a recording cannot be read.
    """
    request = request or CameraRequest()
    scheme = split(uri).scheme
    match scheme:
        case "v4l":
            return LiveCamera(partial(V4lCamera, device_of(uri), request), uri, request)
        case scheme if scheme in NETWORK:
            network.check(uri)
            return LiveCamera(partial(network.Stream, uri), shown(uri), request)
        case "file":
            play = playback_of(uri)
            return RecordedCamera(VideoFile(play.path), fast=play.fast, loop=play.loop)
        case "folder":
            play = playback_of(uri)
            return RecordedCamera(ImageFolder(play.path, play.rate), fast=play.fast, loop=play.loop)
        case "sim":
            raise CameraError(f"{uri} is the simulated camera; it comes with its world, not as a device")
        case _:
            raise CameraError(f"camera {shown(uri)!r} is not understood; allowed are {ALLOWED}")
