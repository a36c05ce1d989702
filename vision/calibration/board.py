"""The printed board: a chessboard with coded markers in its white squares (ChArUco), and how it is found.

Its inner corners can be located to a few hundredths of a pixel, and the markers say which corner is which, so
that a board that is partly covered, or partly outside the picture, is as good as a whole one.

The board's frame is the workspace's when it lies on the plate: origin in its middle, x to the right and y up as
one reads it, z towards the reader, m.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

import cv2
import numpy as np
from cv2.typing import MatLike
from numpy.typing import NDArray

from vision.camera_model import CalibrationError

Image = MatLike
"""A picture (height, width) grey or (height, width, 3) BGR, uint8."""
Floats = NDArray[np.float64]

MODULES = 8
"""A square is this many modules wide: a white rim of one, and a marker of six (a black rim and 4 x 4 bits)."""
MARKER_SHARE = 6 / MODULES
"""Side of a marker over that of its square."""
FEWEST, MOST = 4, 40
"""Squares along one side of a board."""
SMALLEST_SQUARE, LARGEST_SQUARE = 0.003, 0.100
"""Side of a square, m."""
DICTIONARIES = ("4X4_50", "4X4_100", "4X4_250", "4X4_1000")
"""OpenCV's sets of markers, by how many there are in each; the smallest sufficient one confuses the least."""
FEWEST_CORNERS = 8
"""Fewer corners than this are a board at the picture's edge, or a mistake: they would fix its pose poorly."""
FEWEST_LINES = 3
"""They come from so many rows and so many columns at least."""
SMALLEST_WINDOW, LARGEST_WINDOW = 2, 9
"""Half the side of the window in which a corner is refined, px."""
SMOOTHING = 0.3
"""Blur before that, over the window: halves the error of sharp edges, whose place depends on where in a pixel they
fall (measured on rendered boards: 0.037 px without, 0.020 px with it, and no more noise)."""
FINISHED = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 50, 1e-3)
"""A corner's refinement ends when it moves by less than 0.001 px."""


@dataclass(frozen=True, slots=True)
class Board:
    """columns, rows: squares across and down.  square: their side, m.

    The default is 168 x 144 mm: its corners span the 120 mm workspace and it goes on a sheet of A4.
    """

    columns: int = 14
    rows: int = 12
    square: float = 0.012

    def __post_init__(self) -> None:
        if not (FEWEST <= self.columns <= MOST and FEWEST <= self.rows <= MOST):
            raise CalibrationError(
                f"a board has {FEWEST} to {MOST} squares along each side, got {self.columns} x {self.rows}"
            )
        if not SMALLEST_SQUARE <= self.square <= LARGEST_SQUARE:
            raise CalibrationError(
                f"a board's squares are {SMALLEST_SQUARE * 1e3:g} to {LARGEST_SQUARE * 1e3:g} mm wide, "
                f"got {self.square * 1e3:g} mm"
            )

    @property
    def size(self) -> tuple[float, float]:
        """Width and height of the printed squares, m."""
        return self.columns * self.square, self.rows * self.square

    @property
    def marker(self) -> float:
        """Side of a marker, m."""
        return MARKER_SHARE * self.square

    @property
    def dictionary(self) -> str:
        """Name of the markers' set, as OpenCV has it."""
        needed = self.columns * self.rows // 2
        return next(name for name in DICTIONARIES if int(name.removeprefix("4X4_")) >= needed)

    @property
    def corners(self) -> Floats:
        """(n, 2) places of the inner corners on the board, m, in the order of their numbers."""
        width, height = self.size
        across = self.square * np.arange(1, self.columns) - 0.5 * width
        up = 0.5 * height - self.square * np.arange(1, self.rows)
        x, y = np.meshgrid(across, up)
        return np.column_stack([x.ravel(), y.ravel()]).astype(float)

    def modules(self) -> NDArray[np.bool_]:
        """(rows x 8, columns x 8) of the board from above, the top row first: where it is black."""
        black = np.zeros((self.rows * MODULES, self.columns * MODULES), bool)
        marker = 0
        for row in range(self.rows):
            for column in range(self.columns):
                square = black[row * MODULES :, column * MODULES :][:MODULES, :MODULES]
                if (row + column) % 2 == 0:
                    square[:] = True
                else:
                    square[1:-1, 1:-1] = _marker(self.dictionary, marker)
                    marker += 1
        return black

    def image(self, pixels_per_m: float) -> Image:
        """The board as it is printed (height, width), 0 and 255, of at least this resolution.

        Its pixels are whole parts of a module, so its own resolution is its width over `size[0]`; a pixel's
        centre is half a pixel inside its edge.
        """
        module = max(1, math.ceil(pixels_per_m * self.square / MODULES))
        shades = np.where(self.modules(), np.uint8(0), np.uint8(255))
        return np.repeat(np.repeat(shades, module, axis=0), module, axis=1)


@cache
def _marker(dictionary: str, number: int) -> NDArray[np.bool_]:
    """(6, 6) modules of a marker with its black rim: where it is black."""
    return cv2.aruco.generateImageMarker(_dictionary(dictionary), number, 6) == 0


def _dictionary(name: str) -> cv2.aruco.Dictionary:
    numbers = {
        "4X4_50": cv2.aruco.DICT_4X4_50,
        "4X4_100": cv2.aruco.DICT_4X4_100,
        "4X4_250": cv2.aruco.DICT_4X4_250,
        "4X4_1000": cv2.aruco.DICT_4X4_1000,
    }
    return cv2.aruco.getPredefinedDictionary(numbers[name])


@dataclass(frozen=True, slots=True)
class Sighting:
    """A board in one picture. places: (n, 2) of its corners on the board, m.  pixels: (n, 2) in the picture, px.

    numbers: (n,) of these corners on the board.  size: width and height of the picture, px.
    """

    numbers: NDArray[np.int64]
    places: Floats
    pixels: Floats
    size: tuple[int, int]


class BoardFinder:
    """Looks for one kind of board in pictures."""

    def __init__(self, board: Board) -> None:
        self.board = board
        self._corners = board.corners
        parameters = cv2.aruco.CharucoParameters()
        parameters.minMarkers = 1
        """A corner beside a marker that the picture's edge cuts is as sharp as any other."""
        pattern = cv2.aruco.CharucoBoard(
            (board.columns, board.rows), board.square, board.marker, _dictionary(board.dictionary)
        )
        self._detector = cv2.aruco.CharucoDetector(pattern, parameters)

    def find(self, image: Image) -> Sighting | None:
        """The board in a picture (height, width, 3) BGR or (height, width) grey; None when it is not seen."""
        grey = image if image.ndim == 2 else cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)
        corners, numbers, _, _ = self._detector.detectBoard(grey)
        if corners is None or numbers is None or not self._suffices(numbers.ravel()):
            return None
        return self._sighting(grey, corners.reshape(-1, 2), numbers.ravel())

    def _suffices(self, numbers: NDArray) -> bool:
        """Enough corners, and not all in a row or two, of which no pose can be told."""
        rows, columns = np.divmod(numbers, self.board.columns - 1)
        lines = min(len(np.unique(rows)), len(np.unique(columns)))
        return len(numbers) >= FEWEST_CORNERS and lines >= FEWEST_LINES

    def _sighting(self, grey: Image, coarse: NDArray, numbers: NDArray) -> Sighting | None:
        places = self._corners[numbers]
        window = self._window(places, coarse)
        height, width = grey.shape
        rim = window + 1.0
        inside = np.all((coarse >= rim) & (coarse <= (width - 1 - rim, height - 1 - rim)), axis=1)
        if not self._suffices(numbers[inside]):
            return None
        pixels = np.array(coarse[inside].reshape(-1, 1, 2), np.float32, order="C")
        smooth = cv2.GaussianBlur(np.asarray(grey, np.float32), (0, 0), SMOOTHING * window)
        fine = cv2.cornerSubPix(smooth, pixels, (window, window), (-1, -1), FINISHED)
        return Sighting(
            numbers[inside].astype(np.int64),
            places[inside],
            fine.reshape(-1, 2).astype(float),
            (width, height),
        )

    def _window(self, places: Floats, pixels: NDArray) -> int:
        """Half the side of a corner's window, px: as large as it can be without the markers' own corners in it."""
        scale = _spread(pixels) / _spread(places)
        rim = 0.5 * (self.board.square - self.board.marker) * scale
        return int(min(max(math.floor(rim - 1.0), SMALLEST_WINDOW), LARGEST_WINDOW))


def _spread(points: NDArray) -> float:
    """Mean distance of points (n, 2) from their middle."""
    return float(np.linalg.norm(points - points.mean(axis=0), axis=1).mean())
