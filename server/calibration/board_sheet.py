"""The printed board as a PDF at true scale: vector squares, a ruler to check the printer by, and what board it is.

A PDF of rectangles, lines and one standard font is a page of text (ISO 32000-1), so it is written by hand; its
content is not compressed, and a test reads the rectangles back.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from server.settings import MM
from vision.calibration.board import MODULES, Board

POINT = 25.4e-3 / 72.0
"""PDF's unit, m."""
PAPERS = (
    ("A4", 0.297, 0.210),
    ("A3", 0.420, 0.297),
    ("A2", 0.594, 0.420),
    ("A1", 0.841, 0.594),
    ("A0", 1.189, 0.841),
)
"""Landscape: name, width and height, m."""
RIM = 0.010
"""Free on every side, m: no office printer prints to the paper's edge."""
BELOW = 0.030
"""Under the board, for the ruler and the words, m."""
WORDS = 0.180
"""The longest line under the board is so long at most, m; A4 is wider."""
RULER = 0.100
TICK = 0.003
"""Length of the ruler's and the middle's ticks, m."""
LINE = 0.0002
"""Width of a line, m."""
LETTERS = 0.0032
"""Height of the letters, m."""
AXIS_GAP = 0.0015
"""Between the board and the ticks that show its middle, m."""


def board_pdf(board: Board) -> bytes:
    """One page with the board on it, on the smallest paper that it fits on."""
    name, width, height = paper_for(board)
    content = "\n".join([*_drawing(board, width, height), *_words(board, name, width, height)])
    return _document(content, width, height)


def paper_for(board: Board) -> tuple[str, float, float]:
    """Name, width and height (m) of the paper; a larger board than A0 gets a sheet of its own size."""
    width, height = board.size[0] + 2.0 * RIM, board.size[1] + 2.0 * RIM + BELOW
    fitting = (paper for paper in PAPERS if width <= paper[1] and height <= paper[2])
    return next(fitting, ("no standard paper", width, height))


def rectangles(board: Board) -> Iterator[tuple[float, float, float, float]]:
    """Black parts: left, bottom, width, height; m from the board's lower left corner."""
    black = board.modules()
    module, rows = board.square / MODULES, black.shape[0]
    for row, line in enumerate(black):
        steps = np.flatnonzero(np.diff(np.concatenate([[False], line, [False]])))
        for begin, end in zip(steps[0::2].tolist(), steps[1::2].tolist(), strict=True):
            yield begin * module, (rows - 1 - row) * module, (end - begin) * module, module


def _drawing(board: Board, width: float, height: float) -> Iterator[str]:
    """Board, ruler and the ticks that show where its middle is. One path, so that nothing shows between its parts."""
    left, bottom = _corner(board, width, height)
    yield "0 g"
    for x, y, across, up in rectangles(board):
        yield f"{_points(left + x, bottom + y, across, up)} re"
    yield "f"
    yield f"{_points(LINE)} w 0 G"
    for x0, y0, x1, y1 in [*_ruler(_margin(left, width), bottom), *_middle(board, left, bottom)]:
        yield f"{_points(x0, y0)} m {_points(x1, y1)} l S"


def _corner(board: Board, width: float, height: float) -> tuple[float, float]:
    """Of the board on the sheet, lower left, m."""
    return 0.5 * (width - board.size[0]), height - 0.5 * (height - BELOW + board.size[1])


def _margin(left: float, width: float) -> float:
    """Where ruler and words begin: with the board, or further left, so that they end on the sheet; m."""
    return min(left, 0.5 * (width - WORDS))


def _ruler(left: float, bottom: float) -> Iterator[tuple[float, float, float, float]]:
    y = bottom - 0.010
    yield left, y, left + RULER, y
    for step in range(11):
        x = left + 0.1 * step * RULER
        yield x, y, x, y + (TICK if step % 5 == 0 else 0.5 * TICK)


def _middle(board: Board, left: float, bottom: float) -> Iterator[tuple[float, float, float, float]]:
    width, height = board.size
    x, y = left + 0.5 * width, bottom + 0.5 * height
    for begin, way in ((bottom - AXIS_GAP, -1.0), (bottom + height + AXIS_GAP, 1.0)):
        yield x, begin, x, begin + way * TICK
    for begin, way in ((left - AXIS_GAP, -1.0), (left + width + AXIS_GAP, 1.0)):
        yield begin, y, begin + way * TICK, y


def _words(board: Board, paper: str, width: float, height: float) -> Iterator[str]:
    board_left, bottom = _corner(board, width, height)
    left = _margin(board_left, width)
    yield _text("this line is 100 mm long: measure it", left + RULER + 0.004, bottom - 0.011)
    lines = (
        f"Print at 100 % (actual size) on {paper}; glue it to something flat. "
        "The middle, between the four ticks, becomes the origin, and to the right is x.",
        f"pivotrig: ChArUco board, {board.columns} x {board.rows} squares of {board.square / MM:g} mm, "
        f"markers of {board.marker / MM:g} mm, dictionary {board.dictionary}",
    )
    for number, line in enumerate(lines):
        yield _text(line, left, bottom - 0.019 - 1.7 * LETTERS * number, 0.8 * LETTERS)


def _text(words: str, x: float, y: float, size: float = LETTERS) -> str:
    return f"BT /F1 {_points(size)} Tf {_points(x, y)} Td ({words.translate(_ESCAPED)}) Tj ET"


_ESCAPED = str.maketrans({"(": r"\(", ")": r"\)", "\\": r"\\"})


def _points(*lengths: float) -> str:
    return " ".join(f"{length / POINT:.4f}" for length in lengths)


def _document(content: str, width: float, height: float) -> bytes:
    """The page as a PDF file: objects, where each of them begins, and where that table begins."""
    objects = (
        "<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >> >>",
        "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
        f"<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {_points(width, height)}] /Contents 4 0 R "
        "/Resources << /Font << /F1 5 0 R >> >> >>",
        f"<< /Length {len(content)} >>\nstream\n{content}\nendstream",
        "<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica >>",
    )
    file, begins = "%PDF-1.4\n", []
    for number, body in enumerate(objects, start=1):
        begins.append(len(file))
        file += f"{number} 0 obj\n{body}\nendobj\n"
    table = "".join(f"{begin:010d} 00000 n \n" for begin in begins)
    count = len(objects) + 1
    file += f"xref\n0 {count}\n0000000000 65535 f \n{table}trailer\n<< /Size {count} /Root 1 0 R >>\n"
    return f"{file}startxref\n{file.index('xref')}\n%%EOF\n".encode("ascii")
