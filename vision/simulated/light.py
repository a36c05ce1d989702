"""What the light does to a picture: exposure, colour, flicker by rows, a shadow across it, a lamp's mirror image."""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from vision.simulated.figures import Region
from vision.simulated.plate import Colour, Image

MAINS_FLICKER = 100.0
"""Lamps on 50 Hz mains brighten twice a period, Hz."""
READOUT = 0.014
"""A rolling shutter exposes the last row so much later than the first, s (measured on common 60 Hz webcams)."""
COARSE = 4
"""Light that changes slowly over the picture is worked out for one pixel of 4 x 4."""
GLARE_REACH = 3.0
"""A glare spot is drawn to so many of its standard deviations."""


@dataclass(frozen=True, slots=True)
class Band:
    """A straight shadow across the picture.

    angle: of its normal, rad.  offset: of its middle from the picture's middle along the normal, px.
    half_width, softness: half its width and the width of its edge, px.  strength: 0 (none) to 1 (black).
    """

    angle: float
    offset: float
    half_width: float
    softness: float
    strength: float

    def light(self, u: NDArray, v: NDArray) -> NDArray:
        """What it leaves of the light at places relative to the picture's middle, px."""
        across = np.abs(math.cos(self.angle) * u + math.sin(self.angle) * v - self.offset)
        cover = np.clip((self.half_width - across) / self.softness + 0.5, 0.0, 1.0)
        return 1.0 - self.strength * cover


@dataclass(frozen=True, slots=True)
class Flicker:
    """A lamp on the mains seen through a rolling shutter, at one capture time.

    phase: of the light at mid-exposure of the middle row, rad.  depth: of the change, as a share of the light.
    frequency: Hz.
    """

    phase: float
    depth: float
    frequency: float = MAINS_FLICKER

    @classmethod
    def at(
        cls, time: float, exposure: float, depth: float, frequency: float = MAINS_FLICKER, begin: float = 0.0
    ) -> Flicker:
        """At a capture time, s; an exposure (s) of whole periods evens it out.  begin: phase at time 0, rad."""
        phase = (begin + 2.0 * math.pi * frequency * time) % (2.0 * math.pi)
        return cls(phase, depth * float(np.sinc(frequency * exposure)), frequency)

    def light(self, v: NDArray, height: int) -> NDArray:
        """Light of rows relative to the picture's middle, px."""
        later = v * (READOUT / height)
        return 1.0 + self.depth * np.cos(2.0 * math.pi * self.frequency * later + self.phase)


@dataclass(frozen=True, slots=True)
class Light:
    """Of one picture. gain: exposure relative to the usual one.  tint: of the lamp, factors on blue, green, red."""

    gain: float = 1.0
    tint: Colour = (1.0, 1.0, 1.0)
    flicker: Flicker | None = None
    band: Band | None = None

    def fall_on(self, image: Image, dark: float) -> Image:
        """The picture in this light; its grey levels have been darkened by `dark`, and stay so."""
        if self.flicker is None and self.band is None:
            return image if self.is_usual else cv2.LUT(image, self._table(dark))
        factor = self._over((image.shape[1], image.shape[0]))
        channels = [
            _scaled(channel, factor * np.float32(tint), dark)
            for channel, tint in zip(cv2.split(image), self.tint, strict=True)
        ]
        return cv2.merge(channels)

    @property
    def is_usual(self) -> bool:
        return self.gain == 1.0 and self.tint == (1.0, 1.0, 1.0)

    def _table(self, dark: float) -> NDArray:
        """New grey levels (1, 256, 3) of the old."""
        levels = np.arange(256.0)[None, :, None] + dark
        lit = levels * (self.gain * np.array(self.tint)) - dark
        return np.clip(np.rint(lit), 0.0, 255.0).astype(np.uint8)

    def _over(self, size: tuple[int, int]) -> NDArray:
        """The light over the picture (height, width), from a coarse grid: it changes slowly."""
        width, height = size
        columns, rows = max(width // COARSE, 2), max(height // COARSE, 2)
        u = ((np.arange(columns, dtype=np.float32) + 0.5) / columns - 0.5)[None, :] * width
        v = ((np.arange(rows, dtype=np.float32) + 0.5) / rows - 0.5)[:, None] * height
        factor = np.full((rows, columns), self.gain, np.float32)
        if self.flicker is not None:
            factor *= self.flicker.light(v, height)
        if self.band is not None:
            factor *= self.band.light(u, v)
        return np.asarray(cv2.resize(factor, size, interpolation=cv2.INTER_LINEAR))


@dataclass(frozen=True, slots=True)
class Glare:
    """A lamp's mirror image on something shiny: light that is added, enough of it to saturate.

    place: (u, v), px.  along, across: standard deviations, px.  angle: of the long one, rad.
    strength: at its middle, grey levels; far above 255 makes the saturated spot wider than the deviations.
    """

    place: tuple[float, float]
    along: float
    across: float
    angle: float = 0.0
    strength: float = 500.0

    def add_to(self, image: Image) -> None:
        """In place."""
        height, width = image.shape[:2]
        region = Region.around(
            np.array([self.place]), GLARE_REACH * max(self.along, self.across), (width, height)
        )
        if region.is_empty:
            return
        u = np.arange(region.left, region.right, dtype=np.float32)[None, :] - self.place[0]
        v = np.arange(region.top, region.bottom, dtype=np.float32)[:, None] - self.place[1]
        cos, sin = math.cos(self.angle), math.sin(self.angle)
        squares = ((cos * u + sin * v) / self.along) ** 2 + ((cos * v - sin * u) / self.across) ** 2
        added = np.minimum(self.strength * np.exp(-0.5 * squares), 255.0).astype(np.uint8)
        region.of(image)[:] = cv2.add(region.of(image), cv2.merge([added, added, added]))


def _scaled(channel: Image, factor: NDArray, dark: float) -> Image:
    """(channel + dark) factor - dark, saturated; uint8 (height, width)."""
    lit = cv2.multiply(channel, factor, dtype=cv2.CV_32F)
    return cv2.addWeighted(lit, 1.0, factor, dark, -dark, dtype=cv2.CV_8U)
