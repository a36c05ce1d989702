"""How much of each pixel the robot covers: what makes centre and axis good to a fraction of a pixel.

A pixel at the robot's edge sees a mixture, share * light * robot + (1 - share) * shade * ground. Weighed by a
direction in blue, green and red that is perpendicular to the ground's colour, the ground vanishes in any shade; what
is left, over the light that falls on the robot nearby, is the share. So neither a shadow beside the robot nor light
that is uneven along it (a flicker band, a lamp at one side) pulls the centre. Where robot and ground are of one hue
(black on white), brightness alone has to tell them apart.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from cv2.typing import MatLike

from vision.tracking.colour import Colour, Image
from vision.tracking.glare import spots

RIM = 4
"""The blurred edge of a blob reaches that far out of its mask, px: 3 sigma of a lens' 0.7 px, and the 2 px over which
compression smears colour."""
CORE = 2
"""So far inside its mask a blob covers pixels whole, px."""
NEIGHBOURHOOD = 17
"""The light on a pixel of the edge is that on the whole pixels of a square of this side round it, px: much less is
noisy, much more misses a flicker band's slope."""
FEW = 0.01
"""Where fewer of the square's pixels than this share are whole ones the light counts as the mean one."""
LEAST_CHROMA = 20.0
"""Below this difference in colour, grey levels, noise of a few levels would outweigh the shadows it is immune to."""
LEAST_CONTRAST = 1.0
"""Robot and ground that differ by less than this, grey levels, cannot be told apart at all."""
EVEN = 0.03
"""Light whose standard deviation on the robot is below this is even: a sensor's usual noise makes 0.023 of it, and a
slope of the rest would pull the centre by 0.1 px."""
LEAST_LIGHT = 0.2
"""Light on the robot, relative to its mean; less is counted as if it were so much."""
DARK_EDGE, LIT_EDGE = 0.5, 0.95
"""Without colour, the part of the difference in brightness that is taken for the edge: a shadow beside a dark robot
reaches 0.4 of it."""

_RIM_SHAPE = np.ones((2 * RIM + 1, 2 * RIM + 1), np.uint8)
_EDGE_SHAPE = np.ones((2 * CORE + 1, 2 * CORE + 1), np.uint8)


@dataclass(frozen=True, slots=True)
class Masks:
    """255 where something is in a patch (height, width), else 0.

    inside: the blob, holes filled.  others: something else of the robot's colour, neither blob nor ground.
    mark: the mark on the robot's end, which has a colour of its own.
    """

    inside: Image
    others: Image | None = None
    mark: Image | None = None


@dataclass(frozen=True, slots=True)
class Cover:
    """share: of each pixel that is covered, (height, width) float32, 0 beyond the blurred rim.

    blob, ground: mean colours.  hidden: 255 where glare hides whether there is blob or ground; None without any.
    """

    share: MatLike
    blob: Colour
    ground: Colour
    hidden: Image | None


def cover(patch: Image, masks: Masks) -> Cover:
    """patch: (height, width, 3) uint8, the blob with its surroundings."""
    reach, core = cv2.dilate(masks.inside, _RIM_SHAPE), cv2.erode(masks.inside, _EDGE_SHAPE)
    beyond = cv2.bitwise_not(reach)
    if masks.others is not None:
        neither = cv2.bitwise_not(masks.others)
        beyond, reach = cv2.bitwise_and(beyond, neither), cv2.bitwise_and(reach, neither)
    if not cv2.countNonZero(core):
        core = masks.inside
    ground, blob = _mean(patch, beyond), _mean(patch, core)
    hidden = spots(patch, reach, blob, ground)
    plain = core if hidden is None else cv2.bitwise_and(core, cv2.bitwise_not(hidden))
    levels = patch.astype(np.float32)
    if masks.mark is None:
        share = _share(levels, plain, blob if hidden is None else _mean(patch, plain), ground)
    else:
        unmarked = cv2.bitwise_not(cv2.dilate(masks.mark, _EDGE_SHAPE))
        share = cv2.max(
            _share_of_part(patch, levels, cv2.bitwise_and(plain, unmarked), ground),
            _share_of_part(patch, levels, cv2.bitwise_and(plain, masks.mark), ground),
        )
    cv2.copyTo(np.ones(share.shape, np.float32), core, share)
    return Cover(cv2.copyTo(share, reach), blob, ground, hidden)


def _mean(patch: Image, mask: Image) -> Colour:
    blue, green, red, _ = cv2.mean(patch, mask)
    return blue, green, red


def _share_of_part(patch: Image, levels: MatLike, core: Image, ground: Colour) -> MatLike:
    return _share(levels, core, _mean(patch, core), ground)


def _share(levels: MatLike, core: Image, blob: Colour, ground: Colour) -> MatLike:
    """Of the blob in each pixel, from its colour in the core and the ground's; with noise, not limited to 0..1.

    levels: the patch as float32.
    """
    contrast = Contrast.between(blob, ground)
    share = cv2.transform(levels, contrast.row)
    _, spread = cv2.meanStdDev(share, mask=core)
    if not float(spread[0, 0]) <= EVEN:
        share = cv2.divide(share, _light(share, core))
    if contrast.is_coloured:
        return share
    return np.clip((share - DARK_EDGE) * (1.0 / (LIT_EDGE - DARK_EDGE)), 0.0, 1.0)


@dataclass(frozen=True, slots=True)
class Contrast:
    """What tells two colours apart: row . (blue, green, red, 1) is 1 for the blob's and 0 for the ground's.

    row: (1, 4) float32.  is_coloured: 0 for the ground in any light, too.
    """

    row: MatLike
    is_coloured: bool

    @classmethod
    def between(cls, blob: Colour, ground: Colour) -> Contrast:
        bb, gg, bg = _dot(blob, blob), _dot(ground, ground), _dot(blob, ground)
        apart = bb * gg - bg * bg
        if gg > 0.0 and apart >= LEAST_CHROMA**2 * gg:
            # In the plane of the two colours, perpendicular to the ground's.
            return cls(_row(_mixed(blob, gg / apart, ground, -bg / apart), 0.0), True)
        towards = _mixed(blob, 1.0, ground, -1.0)
        direction = _mixed(towards, 1.0 / max(_dot(towards, towards), LEAST_CONTRAST**2), towards, 0.0)
        return cls(_row(direction, -_dot(direction, ground)), False)


def _light(level: MatLike, core: Image) -> MatLike:
    """On the robot's whole pixels nearby, relative to its mean."""
    square = (NEIGHBOURHOOD, NEIGHBOURHOOD)
    whole = cv2.copyTo(np.ones(level.shape, np.float32), core)
    counts = cv2.boxFilter(whole, -1, square, borderType=cv2.BORDER_CONSTANT)
    sums = cv2.boxFilter(cv2.copyTo(level, core), -1, square, borderType=cv2.BORDER_CONSTANT)
    light = (sums + FEW) / (counts + FEW)
    return np.maximum(light, LEAST_LIGHT, out=light)


def _row(direction: Colour, offset: float) -> MatLike:
    return np.array([[*direction, offset]], np.float32)


def _dot(one: Colour, other: Colour) -> float:
    return one[0] * other[0] + one[1] * other[1] + one[2] * other[2]


def _mixed(one: Colour, of_one: float, other: Colour, of_other: float) -> Colour:
    return (
        of_one * one[0] + of_other * other[0],
        of_one * one[1] + of_other * other[1],
        of_one * one[2] + of_other * other[2],
    )
