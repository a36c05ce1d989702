"""Views of the board, gathered for the lens: which ones bring something new, and what is still missing."""

from __future__ import annotations

import math

import cv2
import numpy as np
from numpy.typing import NDArray

from vision.calibration.board import Sighting
from vision.calibration.lens import FEWEST_VIEWS, Lens

Floats = NDArray[np.float64]

ENOUGH_VIEWS = 10
"""With so many different ones the lens is known to a hundredth of a pixel (measured on rendered boards)."""
MOST_VIEWS = 60
"""More bring nothing but time to solve them."""
CELLS = (8, 6)
"""The picture is divided into so many cells, across and down, in each of which a corner should have been seen."""
ENOUGH_COVERAGE = 0.8
"""Share of the cells; beyond the corners that were seen a lens's model is only extrapolated."""
TILTED = math.sin(math.radians(15.0))
"""How far the board's normal should lean each way: less hardly tells the focal length from the distance."""
SAME_PLACE = 0.02
"""A view whose corners are this near to an earlier one's, RMS over the picture's diagonal,"""
SAME_TILT = math.sin(math.radians(5.0))
"""and whose normal leans no further from it than this, brings nothing new."""
STILL = 0.5
"""A board that stands still moves less than this between two frames, px RMS: sensor noise moves it by 0.05 px."""


class Views:
    """The views taken so far. lens: what is assumed of it, to tell how the board is tilted."""

    def __init__(self, lens: Lens) -> None:
        self._lens = lens
        self.taken: list[Sighting] = []
        self._leans: list[Floats] = []
        self._seen = np.zeros((CELLS[1], CELLS[0]), bool)

    def offer(self, sighting: Sighting) -> str:
        """Take a view; "" when it was taken, else why not."""
        if sighting.size != self._lens.size:
            return f"the picture's size has changed to {sighting.size[0]} x {sighting.size[1]} px: begin anew"
        if len(self.taken) >= MOST_VIEWS:
            return f"{MOST_VIEWS} views are enough: solve them, or begin anew"
        lean = self._lean(sighting)
        if any(
            map(self._alike, self.taken, self._leans, [sighting] * len(self.taken), [lean] * len(self.taken))
        ):
            return "too much like an earlier view: move or tilt the board"
        self.taken.append(sighting)
        self._leans.append(lean)
        column, row = self._cells(sighting)
        self._seen[row, column] = True
        return ""

    @property
    def coverage(self) -> float:
        """Share of the picture in which corners have been seen, 0..1."""
        return float(self._seen.mean())

    @property
    def is_enough(self) -> bool:
        return not self._missing()

    @property
    def hint(self) -> str:
        """What to do next, for the person who holds the board."""
        missing = self._missing()
        return missing[0] if missing else "that is enough: solve the lens now, or add views"

    def _missing(self) -> list[str]:
        if not self.taken:
            return ["lay the board flat under the camera"]
        few = [] if len(self.taken) >= ENOUGH_VIEWS else [self._few()]
        return [*self._tilts(), *self._edges(), *few]

    def _few(self) -> str:
        return f"{ENOUGH_VIEWS - len(self.taken)} more: turn the board, or hold it higher or lower"

    def _tilts(self) -> list[str]:
        """The sides that have not been raised yet. Seen from the camera the normal leans away from the raised side."""
        right, down = np.array(self._leans).T
        wanted = {"left": right.max(), "right": -right.min(), "upper": down.max(), "lower": -down.min()}
        return [
            f"raise its {side} side by a hand's width" for side, lean in wanted.items() if not lean >= TILTED
        ]

    def _edges(self) -> list[str]:
        """The side of the picture of which least has been seen, while too little has been seen."""
        if self.coverage >= ENOUGH_COVERAGE:
            return []
        seen = self._seen
        sides = {"left": seen[:, :2], "right": seen[:, -2:], "top": seen[:2], "bottom": seen[-2:]}
        emptiest = min(sides, key=lambda side: float(sides[side].mean()))
        place = emptiest if emptiest in ("top", "bottom") else f"{emptiest} edge"
        return [f"move it to the {place} of the picture"]

    def _cells(self, sighting: Sighting) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Column and row of the cell that each corner is in."""
        share = sighting.pixels / sighting.size
        column, row = np.clip((share * CELLS).astype(np.int64), 0, np.array(CELLS) - 1).T
        return column, row

    def _lean(self, sighting: Sighting) -> Floats:
        """(2,) of the board's normal in the camera frame, x right and y down; its length is the tilt's sine."""
        flat = np.column_stack([sighting.places, np.zeros(len(sighting.places))])
        _, turn, _ = cv2.solvePnP(
            flat, sighting.pixels, self._lens.matrix, self._lens.coefficients, flags=cv2.SOLVEPNP_ITERATIVE
        )
        return np.asarray(cv2.Rodrigues(turn)[0][:2, 2], float)

    def _alike(self, one: Sighting, lean: Floats, other: Sighting, other_lean: Floats) -> bool:
        if not float(np.linalg.norm(lean - other_lean)) <= SAME_TILT:
            return False
        away = moved(one, other)
        return away is not None and away <= SAME_PLACE * math.hypot(*one.size)


def moved(one: Sighting, other: Sighting) -> float | None:
    """How far the corners that both sightings have are apart, px RMS; None when they share none."""
    _, first, second = np.intersect1d(one.numbers, other.numbers, return_indices=True)
    if not len(first):
        return None
    away = one.pixels[first] - other.pixels[second]
    return math.sqrt(float(np.mean(np.sum(away**2, axis=1))))


def stands_still(one: Sighting | None, other: Sighting | None) -> bool:
    """Whether a board was at the same place in two pictures."""
    away = moved(one, other) if one is not None and other is not None else None
    return away is not None and away <= STILL


__all__ = ["ENOUGH_VIEWS", "FEWEST_VIEWS", "Views", "moved", "stands_still"]
