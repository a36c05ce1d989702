"""What is on a canvas or a screenshot, in numbers."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray
from playwright.sync_api import Locator


def pixels(place: Locator) -> NDArray[np.uint8]:
    """A screenshot of one element, (height, width, 3) BGR."""
    picture = cv2.imdecode(np.frombuffer(place.screenshot(), np.uint8), cv2.IMREAD_COLOR)
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
