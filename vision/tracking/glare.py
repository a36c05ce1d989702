"""A lamp's mirror image on the robot: white whatever lies below it, so the robot's shape has to say what does."""

from __future__ import annotations

import cv2
import numpy as np
from cv2.typing import MatLike

from vision.tracking.colour import Colour, Image
from vision.tracking.shape import Ellipse

WHITE = 248
"""Grey level of a saturated pixel, with some noise, in every channel."""
HALO = 2
"""Round the white spot one channel is already saturated and the colours are wrong, px."""
FEWEST = 4
"""Fewer white pixels than this are noise and cover nothing."""
GROUND_BELOW = 235.0
"""On a brighter ground than this, grey levels, white pixels are the ground."""
ROUNDS = 8
"""Guessing the shape and filling the gap by it, in turns: a gap of a tenth is then known to a hundredth of itself."""

_HALO_SHAPE = np.ones((2 * HALO + 1, 2 * HALO + 1), np.uint8)


def spots(patch: Image, reach: Image, blob: Colour, ground: Colour) -> Image | None:
    """255 where glare hides what lies within `reach` (255 on the blob and its rim); None when there is none."""
    white = cv2.inRange(patch, (WHITE, WHITE, WHITE, 0), (255, 255, 255, 255))
    if cv2.countNonZero(white) < FEWEST or not max(min(blob), min(ground)) <= GROUND_BELOW:
        return None
    hidden = cv2.bitwise_and(cv2.dilate(white, _HALO_SHAPE), reach)
    return hidden if cv2.countNonZero(hidden) else None


def completed(share: MatLike, hidden: Image) -> MatLike:
    """The share of each pixel that a rectangle covers, its hidden part as the visible one suggests."""
    guess = share
    for _ in range(ROUNDS):
        moments = cv2.moments(guess)
        if not moments["m00"] > 0.0:
            return share
        guess = share.copy()
        cv2.copyTo(Ellipse.of(moments).cover(*share.shape[:2]), hidden, guess)
    return guess
