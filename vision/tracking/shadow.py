"""Tells a clicked shadow from a clicked robot."""

from __future__ import annotations

import math

import cv2
import numpy as np
from numpy.typing import NDArray

from vision.tracking.colour import Image
from vision.tracking.region import Patch

NEAR = 5
"""What casts a shadow touches it: it is looked for so far beyond the region's rim, px."""
DARKEST, BRIGHTEST = 0.25, 0.95
"""Of the surroundings' brightness, in a shadow: less is hardly seen in a room, more is not seen."""
SAME_TINT = math.sin(math.radians(10.0))
"""A shadow takes away light of the surroundings' own tint: the directions of the two colours differ by less."""
LEAST_TINT = 20.0
"""Off that direction by this, grey levels, a pixel has a colour of its own: beyond the noise of a dim picture."""
LEAST_OWN_TINT = 0.2
"""and by this share of what the shadow takes away."""
FARTHER = 1.5
"""Or it differs from the surroundings by this many times more than the shadow does."""
LEAST_NEIGHBOUR = 0.5
"""What casts a shadow covers at least this share of the shadow's area."""


def looks_like_a_shadow(image: Image, patch: Patch) -> bool:
    """Whether a region is its surroundings, darkened, beside something that differs from them in another way."""
    u0, v0, u1, v1 = patch.window
    part = image[v0:v1, u0:u1].astype(np.float32)
    reach = cv2.dilate(patch.inside, np.ones((2 * NEAR + 1, 2 * NEAR + 1), np.uint8)) > 0
    if reach.all():
        return False
    region, ground = part[patch.inside > 0].mean(axis=0), np.median(part[~reach], axis=0)
    full = float(np.linalg.norm(ground))
    if not DARKEST * full <= float(np.linalg.norm(region)) <= BRIGHTEST * full:
        return False
    contrast, tint = _taken_away(region, ground)
    if not tint <= SAME_TINT * contrast:
        return False
    less, own = _taken_away(part, ground)
    other = (np.abs(less) > FARTHER * contrast) | (own > max(LEAST_TINT, LEAST_OWN_TINT * contrast))
    other &= patch.inside == 0
    return _touching(other, reach) >= LEAST_NEIGHBOUR * patch.area


def _taken_away(colours: NDArray, ground: NDArray) -> tuple[NDArray, NDArray]:
    """How much less light than the surroundings (..., 3) colours have: along the surroundings' tint, and off it."""
    along = ground / max(float(np.linalg.norm(ground)), 1.0)
    less = (ground - colours) @ along
    return less, np.linalg.norm(ground - colours - less[..., None] * along, axis=-1)


def _touching(other: NDArray[np.bool_], reach: NDArray[np.bool_]) -> int:
    """px^2 of the largest patch of something else that comes near the region."""
    count, labels, stats, _ = cv2.connectedComponentsWithStats(other.astype(np.uint8), connectivity=8)
    near = np.unique(labels[reach])
    return max((int(stats[label, cv2.CC_STAT_AREA]) for label in near if 0 < label < count), default=0)
