"""Where in the picture to look: the window that surely holds the body."""

from __future__ import annotations

import math

from vision.tracking.coverage import RIM
from vision.tracking.detection import Window

Place = tuple[float, float]
"""(u, v) in the picture, px."""

SPARE = RIM
"""A body that just fits leaves this much room to the window's edge for its blurred rim, px."""
SIGMAS = 4.0
"""The window holds the body when its heading is that many standard deviations off."""


def half_extent(length: float, width: float, ahead: Place, axis_sigma: float) -> Place:
    """Half of the extent along u and v, px, of a body of this length and width, px.

    ahead: a vector along its long axis in the picture, which is known to `axis_sigma`, rad.
    """
    play = SIGMAS * axis_sigma
    play = math.sin(play) if play <= 0.5 * math.pi else 1.0
    du, dv = ahead
    size = math.hypot(du, dv) or 1.0
    along_u, along_v = min(abs(du) / size + play, 1.0), min(abs(dv) / size + play, 1.0)
    return 0.5 * (length * along_u + width * along_v), 0.5 * (length * along_v + width * along_u)


def window_around(place: Place, half: Place, whole: Window) -> Window:
    """The part of the picture within `half` (px along u and v) of a place; at least one pixel of it."""
    _, _, width, height = whole
    left, right = _span(place[0], half[0], width)
    top, bottom = _span(place[1], half[1], height)
    return left, top, right, bottom


def _span(place: float, half: float, limit: int) -> tuple[int, int]:
    """From a place less half to a place plus half, within 0..limit; a far place yields the nearest pixel."""
    low, high = place - half, place + half
    if low >= 0.0 and low + 1.0 <= high <= limit:
        return math.floor(low), math.ceil(high)
    half = min(half, float(limit))
    place = min(max(place, -half), limit + half)
    low = min(max(math.floor(place - half), 0), limit - 1)
    return low, max(min(math.ceil(place + half), limit), low + 1)


def touches(box: Window, window: Window) -> bool:
    """Whether a box reaches the window's edge, so that the window may have cut the blob."""
    return box[0] <= window[0] or box[1] <= window[1] or box[2] >= window[2] or box[3] >= window[3]
