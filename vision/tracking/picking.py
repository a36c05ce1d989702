"""The robot's colour from one click on it: a proposal of thresholds and size, with what speaks against it in words."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import cv2
import numpy as np
from numpy.typing import NDArray

from vision.camera_model import CameraModel
from vision.tracking import thresholds
from vision.tracking.colour import ColourRange, Image
from vision.tracking.detection import Blob, Candidate, RegionFilter, Window, find, measure
from vision.tracking.region import Patch, grow
from vision.tracking.shadow import looks_like_a_shadow
from vision.tracking.thresholds import Colours, Fit

Part = Literal["body", "end_mark"]

REACH = 2.5
"""What belongs together is looked for within this many body lengths of the click: a robot whose length in the rig
file is wrong by a factor of two is still seen whole, with surroundings to tell it from."""
LEAST_REACH_PX = 40
LEAST_AREA = {"body": 3e-6, "end_mark": 0.3e-6}
"""m^2: a third of the smallest robot of this kind (10 mm^2), and a dot of half a millimetre."""
LEAST_PIXELS = {"body": 30, "end_mark": 6}
"""px^2: below, there are too few pixels inside the blurred rim to know a colour by."""
AREA_FACTOR = 2.2
"""The area may be smaller or larger than the clicked one by this: light, blur and tilt change it by a fifth each, and
two robots in contact must not pass for one."""
RIM = 4
"""Pixels so close outside the clicked region are a mixture with its surroundings and tell of neither, px."""
CORE_RIM = 1
"""The same inside it, px."""
SAMPLES = 10_000
"""Pixels of the surroundings, and of the rest of the picture, that are looked at: enough for one in a thousand."""
ROUND = 1.4
"""A blob less elongated than this has no axis; the tracker does not take it."""
CLOSE = 0.35
"""A separation below this is worth a warning: sensor noise of a dim picture takes a quarter of the room."""
FAR_COST = 0.5
"""Thresholds may lose so much of their separation from the surroundings for the sake of the rest of the picture."""
DARK = 40
"""A robot with less value than this, 0..255, drowns in the sensor's noise when its light is halved."""
CLIPPED = 253
"""A channel from this value on may have been brighter."""


class PickError(ValueError):
    """A click that gives no colour; the text says what was found there, and what to do."""


@dataclass(frozen=True, slots=True)
class Sight:
    """The picture that was clicked into. camera: its model.  height: of the robot's top above the plate, m.
    length: of its body, m, roughly."""

    image: Image
    camera: CameraModel
    height: float
    length: float


@dataclass(frozen=True, slots=True)
class Proposal:
    """Thresholds that would find what was clicked.

    region: its size, m^2.  separation: how far the surroundings' colours are away, 0 (the same) to 1.
    light_change: change of brightness that the thresholds bear, as a fraction.
    box: of the blob in the picture, px.  mask: (height, width), 255 where the picture has the colour.
    """

    colour: ColourRange
    region: RegionFilter
    separation: float
    light_change: float
    warnings: tuple[str, ...]
    box: Window
    mask: NDArray[np.uint8]


def pick(sight: Sight, place: tuple[float, float], part: Part = "body") -> Proposal:
    """What was clicked at a place (u, v), px; raises `PickError`."""
    u, v = _pixel(place, sight.image)
    scale = _scale(sight, u, v)
    patch = _patch(sight, (u, v), scale, part)
    robot, ring, rest = _samples(sight.image, patch)
    fit = _fit(robot, ring, rest)
    mask = np.asarray(fit.colour.mask(sight.image), np.uint8)
    area = _area(mask, patch)
    region = RegionFilter(area / AREA_FACTOR / scale**2, area * AREA_FACTOR / scale**2)
    found = find(sight.image, (0, 0, *sight.camera.size), fit.colour, region.scaled(scale**2))
    blob = _measured(sight.image, found, patch)
    warnings = (*_of_colour(fit, robot), *_of_blob(blob, part), *_of_others(found, blob, mask))
    return Proposal(fit.colour, region, fit.separation, fit.light_change, warnings, blob.box, mask)


def _pixel(place: tuple[float, float], image: Image) -> tuple[int, int]:
    height, width = image.shape[:2]
    u, v = place
    if not (-0.5 <= u < width - 0.5 and -0.5 <= v < height - 0.5):
        raise PickError(
            f"the click at ({u:.0f}, {v:.0f}) px is outside the picture, which is {width}x{height} px"
        )
    return round(u), round(v)


def _scale(sight: Sight, u: int, v: int) -> float:
    """px/m at the height of the robot's top, where the click is."""
    scale = sight.camera.scale_at(*sight.camera.to_point(u, v, sight.height), sight.height)
    if not (math.isfinite(scale) and scale > 0.0):
        raise PickError("the camera's calibration has no scale there; calibrate the camera first")
    return scale


def _patch(sight: Sight, place: tuple[int, int], scale: float, part: Part) -> Patch:
    patch = grow(sight.image, place, max(round(REACH * sight.length * scale), LEAST_REACH_PX))
    if patch is None:
        raise PickError(
            "the click is not on a blob: nothing of one colour stands out from its surroundings there; "
            "click in the middle of the robot, not on a bright spot"
        )
    least = max(LEAST_AREA[part], LEAST_PIXELS[part] / scale**2)
    if not patch.area >= least * scale**2:
        raise PickError(
            f"the click is not on a blob: {patch.area / scale**2 * 1e6:.1f} mm² found, at least {least * 1e6:.1f} mm² "
            "needed; click in the middle of the robot, not on a bright spot"
        )
    _refuse_cut(patch, sight.image)
    if part == "body" and looks_like_a_shadow(sight.image, patch):
        raise PickError(
            "the click is on something that looks like a shadow beside another blob; click on the robot itself"
        )
    return patch


def _refuse_cut(patch: Patch, image: Image) -> None:
    height, width = image.shape[:2]
    (u0, v0, u1, v1), (left, top, right, bottom) = patch.box, patch.window
    if u0 <= 0 or v0 <= 0 or u1 >= width or v1 >= height:
        raise PickError(
            "what was clicked reaches the border of the picture: put the robot further inside, or click on the robot"
        )
    if u0 <= left or v0 <= top or u1 >= right or v1 >= bottom:
        raise PickError(
            "what was clicked is much larger than the robot; click on the robot, and see that robot.body_length_mm in "
            "the rig file is its length"
        )


def _samples(image: Image, patch: Patch) -> tuple[Colours, Colours, Colours]:
    """Pixels (n, 3) of what was clicked, of its surroundings, and of the rest of the picture."""
    u0, v0, u1, v1 = patch.window
    picture = np.asarray(image, np.uint8)
    part = picture[v0:v1, u0:u1]
    core = cv2.erode(patch.own, _square(CORE_RIM))
    inside = core if np.count_nonzero(core) >= LEAST_PIXELS["end_mark"] else patch.own
    outside = cv2.dilate(cv2.bitwise_or(patch.inside, patch.alike), _square(RIM)) == 0
    elsewhere = np.ones(image.shape[:2], bool)
    elsewhere[v0:v1, u0:u1] = False
    ring = part[outside]
    if not len(ring):
        raise _same_colour()
    return part[inside > 0], _some(ring), _some(picture[elsewhere])


def _some(colours: Colours) -> Colours:
    return colours[:: max(len(colours) // SAMPLES, 1)]


def _square(half: int) -> NDArray[np.uint8]:
    return np.ones((2 * half + 1, 2 * half + 1), np.uint8)


def _fit(robot: Colours, ring: Colours, rest: Colours) -> Fit:
    """Thresholds against everything that is seen; where the rest of the picture has the colour too, against the
    surroundings alone: what is far away can be told by its place."""
    fit, near = thresholds.fit(robot, np.vstack([ring, rest])), thresholds.fit(robot, ring)
    if near is not None and (fit is None or fit.separation < FAR_COST * near.separation):
        fit = near
    if fit is None:
        raise _same_colour()
    return fit


def _same_colour() -> PickError:
    return PickError(
        "the background has the same colour as what was clicked; put the robot on another background, or a "
        "coloured sticker on the robot"
    )


def _area(mask: NDArray[np.uint8], patch: Patch) -> int:
    """px^2 of the mask's blobs in the clicked region."""
    u0, v0, u1, v1 = patch.window
    _, labels = cv2.connectedComponents(mask[v0:v1, u0:u1], connectivity=8)
    here = labels[(patch.inside > 0) & (labels > 0)]
    if here.size == 0:
        raise _no_blob()
    return int(np.count_nonzero(labels == np.bincount(here).argmax()))


def _measured(image: Image, found: list[Candidate], patch: Patch) -> Blob:
    """The blob that was clicked, as the tracker would see it."""
    (u0, v0, u1, v1), height, width = patch.box, *image.shape[:2]
    here = [each for each in found if u0 <= each.centre[0] <= u1 and v0 <= each.centre[1] <= v1]
    if not here:
        raise _no_blob()
    return measure(image, (0, 0, width, height), here[0])


def _no_blob() -> PickError:
    return PickError(
        "no thresholds make one blob of what was clicked: its colour is uneven, or the background has much of it; "
        "use more even light, or another background"
    )


def _of_colour(fit: Fit, robot: Colours) -> list[str]:
    warnings = []
    if not fit.separation >= CLOSE:
        warnings.append("the background has nearly the same colour: the robot may be lost in places")
    if not fit.light_change >= thresholds.LIGHT_CHANGES[0]:
        warnings.append(
            f"this colour holds while the light changes by less than {100 * max(fit.light_change, 0.05):.0f} %: "
            "keep the light as it is, or save a profile for each light"
        )
    value = float(np.median(robot.max(axis=1)))
    if not value >= DARK and fit.colour.saturation[1] > 0 and fit.colour.hue != (0.0, 360.0):
        warnings.append("the robot is very dark in the picture: more light or a longer exposure would help")
    if float(np.mean((robot >= CLIPPED).all(axis=1))) > 0.5 and fit.separation < 1.0:
        warnings.append("the robot is over-exposed: less light or a shorter exposure would help")
    return warnings


def _of_blob(blob: Blob, part: Part) -> list[str]:
    if part == "end_mark" or blob.elongation >= ROUND:
        return []
    return [
        "what was clicked is hardly longer than wide, so that it has no heading; click on a part as long as the robot, "
        "or choose the colour of the mark on its end too"
    ]


def _of_others(found: list[Candidate], blob: Blob, mask: NDArray[np.uint8]) -> list[str]:
    warnings = []
    others = len(found) - 1
    if others > 0:
        there = "is 1 other blob that looks" if others == 1 else f"are {others} other blobs that look"
        warnings.append(
            f"there {there} the same: take them away, or the robot has to be clicked after each loss"
        )
    if _touches_border(mask, blob.area):
        warnings.append("the same colour is seen at the border of the picture")
    return warnings


def _touches_border(mask: NDArray[np.uint8], area: float) -> bool:
    """Whether a patch of the mask of at least half the robot's size reaches the picture's border."""
    count, labels, stats, _ = cv2.connectedComponentsWithStats(mask, connectivity=8)
    edge = np.unique(np.concatenate([labels[0], labels[-1], labels[:, 0], labels[:, -1]]))
    return any(stats[label, cv2.CC_STAT_AREA] >= 0.5 * area for label in edge if 0 < label < count)
