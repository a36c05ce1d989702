"""The PDF of the board: read back, it is the board at true scale, and the board is found on it."""

import re

import numpy as np
import pytest

from server.calibration.board_sheet import board_pdf, paper_for
from vision.calibration.board import Board, BoardFinder

POINT = 25.4e-3 / 72.0
MEAN_WIDTH = 0.5
"""Of Helvetica's letters in English text, over their size."""
PIXEL = 0.25e-3
"""Of the page as it is drawn here, m."""


def numbers(pattern: str, pdf: bytes) -> np.ndarray:
    """The numbers of each operator that matches, m."""
    found = re.findall(pattern, pdf.decode("ascii"), re.MULTILINE)
    return np.array([[float(value) for value in line.split()] for line in found]) * POINT


def first_number(pattern: bytes, pdf: bytes) -> int:
    return int(re.findall(pattern, pdf)[0])


def drawn(pdf: bytes) -> tuple[np.ndarray, float]:
    """The page (height, width) grey, and its height, m."""
    width, height = numbers(r"/MediaBox \[0 0 ([\d. ]+)\]", pdf)[0]
    page = np.full((round(height / PIXEL), round(width / PIXEL)), 255, np.uint8)
    for left, bottom, across, up in numbers(r"^([\d. ]+) re$", pdf):
        top, end = round((height - bottom - up) / PIXEL), round((height - bottom) / PIXEL)
        page[top:end, round(left / PIXEL) : round((left + across) / PIXEL)] = 0
    return page, height


@pytest.mark.parametrize("board", [Board(), Board(8, 6, 0.020), Board(20, 12, 0.018)])
def test_the_page_shows_the_board_at_true_scale(board: Board):
    page, _ = drawn(board_pdf(board))
    sighting = BoardFinder(board).find(page)
    assert sighting is not None
    assert len(sighting.numbers) == len(board.corners)
    seen = (sighting.pixels + 0.5) * PIXEL * (1.0, -1.0)
    assert seen - seen.mean(axis=0) == pytest.approx(board.corners, abs=0.05e-3)


def test_the_ruler_is_100_mm_long_and_lies_below_the_board():
    pdf = board_pdf(Board())
    lines = numbers(r"^([\d.]+ [\d.]+) m [\d. ]+ l S$", pdf), numbers(r"m ([\d.]+ [\d.]+) l S$", pdf)
    lengths = np.hypot(*(lines[1] - lines[0]).T)
    assert lengths.max() == pytest.approx(0.100, abs=1e-6)
    board_bottom = numbers(r"^([\d. ]+) re$", pdf)[:, 1].min()
    assert lines[0][lengths.argmax(), 1] < board_bottom - 0.005


@pytest.mark.parametrize("board", [Board(4, 4, 0.003), Board(6, 6, 0.010), Board(), Board(40, 40, 0.1)])
def test_ruler_and_words_are_on_the_sheet_however_small_the_board(board: Board):
    pdf = board_pdf(board).decode("ascii")
    width = numbers(r"/MediaBox \[0 0 ([\d. ]+)\]", board_pdf(board))[0, 0]
    texts = re.findall(r"/F1 ([\d.]+) Tf ([\d.]+) [\d.]+ Td \((.*)\) Tj", pdf)
    assert len(texts) == 3
    for size, left, words in texts:
        end = float(left) + MEAN_WIDTH * float(size) * len(words)
        assert float(left) * POINT >= 0.010
        assert end * POINT <= width - 0.010
    ruler = numbers(r"m ([\d.]+ [\d.]+) l S$", board_pdf(board))[:12]
    assert ruler[:, 0].max() <= width - 0.009


def test_four_ticks_show_the_middle_of_the_board():
    board = Board()
    pdf = board_pdf(board)
    rectangles = numbers(r"^([\d. ]+) re$", pdf)
    middle = np.array([rectangles[:, 0].min(), rectangles[:, 1].min()]) + 0.5 * np.array(board.size)
    starts = numbers(r"^([\d.]+ [\d.]+) m [\d. ]+ l S$", pdf)[-4:]
    on_an_axis = np.abs(starts - middle).min(axis=1)
    assert on_an_axis == pytest.approx(0.0, abs=1e-6)


def test_the_words_tell_how_to_print_it_and_what_it_is():
    pdf = board_pdf(Board(8, 6, 0.020)).decode("ascii")
    assert "Print at 100 %" in pdf
    assert "8 x 6 squares of 20 mm, markers of 15 mm, dictionary 4X4_50" in pdf
    assert "/PrintScaling /None" in pdf


def test_the_default_board_goes_on_a_sheet_of_a4_and_larger_ones_on_larger_sheets():
    assert paper_for(Board())[0] == "A4"
    assert paper_for(Board(20, 12, 0.018))[0] == "A3"
    assert paper_for(Board(40, 40, 0.1))[0] == "no standard paper"


def test_every_object_of_the_file_is_where_its_table_says():
    pdf = board_pdf(Board())
    start = first_number(rb"startxref\n(\d+)", pdf)
    assert pdf[start:].startswith(b"xref")
    for number, begin in enumerate(re.findall(rb"(\d{10}) 00000 n", pdf), start=1):
        assert pdf[int(begin) :].startswith(b"%d 0 obj" % number)
    length = first_number(rb"/Length (\d+)", pdf)
    assert pdf[pdf.index(b"stream\n") + 7 :][length:].startswith(b"\nendstream")
