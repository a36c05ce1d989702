"""The patch of one colour round a click: the robot, if it is one that stands out.

Of all thresholds on the distance in colour from the clicked place, the region that changes least over the widest
range of thresholds is taken (the idea of maximally stable extremal regions, Matas et al. 2002): noise and shading
stay below that range, the surroundings above it, and no figure for either has to be guessed.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from cv2.typing import MatLike
from numpy.typing import NDArray

from vision.tracking.colour import Image
from vision.tracking.detection import Window

BRIGHTNESS_WEIGHT = 0.5
"""Of a difference in brightness against one in colour: light and shadow change the first, rarely the second."""
FIRST_THRESHOLD = 3.0
"""Least distance in colour, grey levels: below the noise of a calm camera."""
THRESHOLD_RATIO = 1.1
THRESHOLDS = 44
"""From 3 to 180 grey levels in steps of 10 %."""
STABLE_GROWTH = 1.35
"""A region that grows by less than this while the threshold rises counts as the same one: its rim is blurred, by 2 px
in a JPEG picture, which keeps colour at half the resolution."""
LEAST_STABILITY = 6
"""A region must stay the same over as many thresholds (a factor of 1.8) to be told from a soft shadow or noise."""
ALIKE_SIZE = 5.0
"""A patch of the same colour is something of its own, not the background, up to this many times smaller or larger."""
LARGEST_SHARE = 0.4
"""Of the window; what covers more of it is what the robot lies on."""


@dataclass(frozen=True, slots=True)
class Patch:
    """A region of one colour.

    window: the part of the picture that was looked at, px.  inside: (height, width) of the window, 255 within the
    region, holes filled.  own: the same without its holes, a glare spot or a mark.  alike: other patches of the same
    colour and about the same size.  stability: over how many thresholds it is the same region.
    """

    window: Window
    inside: NDArray[np.uint8]
    own: NDArray[np.uint8]
    alike: NDArray[np.uint8]
    stability: int

    @property
    def area(self) -> int:
        """px^2."""
        return int(np.count_nonzero(self.inside))

    @property
    def box(self) -> Window:
        """Of the region in the picture, px."""
        u, v, width, height = cv2.boundingRect(self.inside)
        left, top = self.window[0] + u, self.window[1] + v
        return left, top, left + width, top + height


def grow(image: Image, place: tuple[int, int], reach: int) -> Patch | None:
    """The patch at a place (u, v) px; None where nothing stands out within `reach` px of it."""
    window = _around(place, reach, image)
    u0, v0, u1, v1 = window
    seed = place[0] - u0, place[1] - v0
    distance = _distance(image[v0:v1, u0:u1], seed)
    regions = _regions(distance, seed)
    stability, chosen = _most_stable([int(np.count_nonzero(region)) for region in regions])
    if stability < LEAST_STABILITY:
        return None
    own = regions[chosen]
    alike = _alike(distance <= _threshold(chosen), own)
    return Patch(window, _without_holes(own), own, alike, stability)


def _around(place: tuple[int, int], reach: int, image: Image) -> Window:
    (u, v), (height, width) = place, image.shape[:2]
    return max(u - reach, 0), max(v - reach, 0), min(u + reach + 1, width), min(v + reach + 1, height)


def _distance(part: Image, seed: tuple[int, int]) -> MatLike:
    """Of each pixel's colour from that at the seed, grey levels, float32."""
    calm = cv2.medianBlur(np.ascontiguousarray(part), 3).astype(np.float32)
    u, v = seed
    colour = np.median(calm[max(v - 1, 0) : v + 2, max(u - 1, 0) : u + 2].reshape(-1, 3), axis=0)
    difference = calm - colour
    grey = difference.mean(axis=2)
    chroma = difference - grey[:, :, None]
    return np.sqrt(3.0 * (BRIGHTNESS_WEIGHT * grey) ** 2 + (chroma**2).sum(axis=2))


def _regions(distance: MatLike, seed: tuple[int, int]) -> list[NDArray[np.uint8]]:
    """The connected regions round the seed for rising thresholds, until they spread over the surroundings."""
    u, v = seed
    regions: list[NDArray[np.uint8]] = []
    for step in range(THRESHOLDS):
        near = (distance <= _threshold(step)).astype(np.uint8)
        near[v, u] = 1
        _, labels = cv2.connectedComponents(near, connectivity=4)
        region = np.where(labels == labels[v, u], np.uint8(255), np.uint8(0))
        if np.count_nonzero(region) > LARGEST_SHARE * region.size:
            break
        regions.append(region)
    return regions


def _threshold(step: int) -> float:
    return FIRST_THRESHOLD * THRESHOLD_RATIO**step


def _alike(near: NDArray[np.bool_], own: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """The patches of what is as near in colour, 255; those that the window cuts may be small in it."""
    size = np.count_nonzero(own)
    others = (near & (own == 0)).astype(np.uint8)
    _, labels, stats, _ = cv2.connectedComponentsWithStats(others, connectivity=4)
    areas = stats[:, cv2.CC_STAT_AREA]
    is_cut = np.isin(np.arange(len(areas)), _on_the_edge(labels))
    of_size = ((areas * ALIKE_SIZE >= size) | is_cut) & (areas <= ALIKE_SIZE * size)
    of_size[0] = False
    return np.where(of_size[labels], np.uint8(255), np.uint8(0))


def _on_the_edge(labels: NDArray) -> NDArray:
    return np.unique(np.concatenate([labels[0], labels[-1], labels[:, 0], labels[:, -1]]))


def _most_stable(areas: list[int]) -> tuple[int, int]:
    """Over how many thresholds the most stable region stays the same, and the number of the middle one of them."""
    best = 0, 0
    for first, area in enumerate(areas):
        same = sum(1 for later in areas[first:] if later <= STABLE_GROWTH * area)
        best = max(best, (same, first), key=lambda pair: pair[0])
    same, first = best
    return same, first + same // 2


def _without_holes(region: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """A glare spot or a mark in its middle belongs to the robot."""
    outlines, _ = cv2.findContours(region, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    return np.asarray(cv2.drawContours(np.zeros_like(region), outlines, -1, 255, cv2.FILLED), np.uint8)
