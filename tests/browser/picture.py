"""What is on a canvas or a screenshot, in numbers."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray
from playwright.sync_api import Locator


def pixels(place: Locator) -> NDArray[np.uint8]:
    """A screenshot of one element, (height, width, 3) BGR."""
    return decoded(place.screenshot())


def pixels_in_view(place: Locator) -> NDArray[np.uint8]:
    """The same of an element in the window, at once, also on a busy page; black where there is none."""
    box = place.bounding_box() if place.count() == 1 else None
    if box is None:
        return np.zeros((1, 1, 3), np.uint8)
    return decoded(place.page.screenshot(clip=box, timeout=60e3))


def decoded(png: bytes) -> NDArray[np.uint8]:
    picture = cv2.imdecode(np.frombuffer(png, np.uint8), cv2.IMREAD_COLOR)
    assert picture is not None
    return np.asarray(picture, dtype=np.uint8)


def colours(picture: NDArray[np.uint8]) -> int:
    """How many different colours there are, at 16 levels a channel."""
    coarse = (picture >> 4).astype(np.uint32)
    return len(np.unique(coarse[..., 0] << 8 | coarse[..., 1] << 4 | coarse[..., 2]))


def share_like(picture: NDArray[np.uint8], bgr: tuple[int, int, int], within: int = 30) -> float:
    """Share of the pixels that have about this colour."""
    distance = np.abs(picture.astype(int) - np.array(bgr)).max(axis=2)
    return float((distance <= within).mean())
