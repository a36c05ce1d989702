"""A folder of pictures as a film: in the order in which a person would number them."""

from __future__ import annotations

import re
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from vision.sources.recorded import Still
from vision.sources.request import CameraError, Size

KINDS = frozenset({".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".webp"})
RATE = 30.0
"""Pictures/s unless the URI says otherwise."""

_JPEG, _JPEG_END = b"\xff\xd8", b"\xff\xd9"
_PNG, _PNG_END = b"\x89PNG", b"IEND\xaeB\x60\x82"


class ImageFolder:
    """A film of `vision.sources.recorded`; raises `CameraError` when there is no picture in the folder.

    The first good picture gives the size; one of another size counts as damaged.
    """

    def __init__(self, path: Path, rate: float | None = None) -> None:
        self.name = f"folder {path}"
        self.identity = f"folder {path.name or path.resolve().name}"
        self.rate = RATE if rate is None else rate
        self.damaged = 0
        self._pictures = self._found(path)
        self._index = -1
        self.size = self._first_size()

    def advance(self) -> Still | None:
        if self._index + 1 >= len(self._pictures):
            return None
        self._index += 1
        return Still(self._index / self.rate, self._index)

    def picture(self) -> NDArray[np.uint8] | None:
        image = load_picture(self._pictures[self._index])
        if image is None or size_of(image) != self.size:
            self.damaged += 1
            return None
        return image

    def rewind(self) -> None:
        self._index = -1

    def close(self) -> None:
        self._pictures = []

    def _found(self, path: Path) -> list[Path]:
        try:
            files = sorted(path.iterdir(), key=lambda file: natural_order(file.name))
        except OSError as error:
            raise CameraError(f"{self.name} cannot be read: {error.strerror}; give its whole path") from error
        pictures = [file for file in files if file.suffix.lower() in KINDS]
        if not pictures:
            raise CameraError(f"{self.name} holds no pictures; understood are {', '.join(sorted(KINDS))}")
        return pictures

    def _first_size(self) -> Size:
        for picture in self._pictures:
            image = load_picture(picture)
            if image is not None:
                return size_of(image)
        raise CameraError(f"{self.name} holds {len(self._pictures)} pictures, and none of them can be read")


def natural_order(name: str) -> list[tuple[int, str]]:
    """A key that puts "picture 9" before "picture 10"."""
    return [
        (int(part), "") if part.isdecimal() else (-1, part) for part in re.split(r"([0-9]+)", name.lower())
    ]


def load_picture(path: Path) -> NDArray[np.uint8] | None:
    """(height, width, 3) BGR; None for a file that is no whole picture."""
    try:
        data = path.read_bytes()
    except OSError:
        return None
    if not data or _is_cut_off(data):
        return None
    try:
        image = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)
    except cv2.error:  # it states a size that no picture has
        return None
    return None if image is None else np.asarray(image, np.uint8)


def _is_cut_off(data: bytes) -> bool:
    """The decoders fill up what is missing with grey, and say so only to the terminal."""
    end = data.rstrip(b"\0")
    if data.startswith(_JPEG):
        return not end.endswith(_JPEG_END)
    return data.startswith(_PNG) and not end.endswith(_PNG_END)


def size_of(image: NDArray[np.uint8]) -> Size:
    height, width = image.shape[:2]
    return width, height
