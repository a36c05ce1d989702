"""The printed board and the lens: found to hundredths of a pixel, solved, refused with what to do."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
from scripted_board import BOARD, MILD, NEAR, STRONG, flat, projected, projected_views, rendered

from vision.calibration.board import Board, BoardFinder
from vision.calibration.lens import Lens, solve_lens
from vision.calibration.views import ENOUGH_VIEWS, Views, moved, stands_still
from vision.camera_model import CalibrationError, CameraModel
from vision.simulated.held_board import FLAT, HELD, Holding

NOISE = 0.03
"""Of a corner found in a rendered picture, px."""


@pytest.mark.parametrize("size", [(14, 12), (5, 7), (8, 6), (25, 30)])
def test_the_board_is_drawn_as_opencv_draws_it(size: tuple[int, int]):
    board = Board(*size, 0.012)
    dictionary = cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, f"DICT_{board.dictionary}"))
    theirs = cv2.aruco.CharucoBoard(size, board.square, board.marker, dictionary)
    ours = board.image(1000.0)
    assert np.array_equal(ours, theirs.generateImage((ours.shape[1], ours.shape[0]), None, 0, 1))


@pytest.mark.parametrize("size", [(3, 12), (14, 41)])
def test_a_board_of_too_few_or_too_many_squares_is_refused_with_what_is_allowed(size: tuple[int, int]):
    with pytest.raises(CalibrationError, match="4 to 40 squares"):
        Board(*size)
    with pytest.raises(CalibrationError, match="3 to 100 mm"):
        Board(square=float("nan"))


def test_corners_are_found_to_a_twentieth_of_a_pixel_flat_and_tilted():
    for holding, sighting in zip(HELD[:3], rendered(STRONG, HELD[:3], 1)[0], strict=True):
        true = projected(STRONG, holding, 0.0, 0)
        _, seen, real = np.intersect1d(sighting.numbers, true.numbers, return_indices=True)
        away = sighting.pixels[seen] - true.pixels[real]
        assert len(seen) > 0.7 * len(BOARD.corners)
        assert np.sqrt(np.mean(np.sum(away**2, axis=1))) < 0.05
        assert np.abs(away.mean(axis=0)).max() < 0.01


def test_no_board_is_found_where_there_is_none():
    plate = np.full((480, 640, 3), 170, np.uint8)
    assert BoardFinder(BOARD).find(plate) is None
    noise = np.random.default_rng(1).integers(0, 255, plate.shape, np.uint8)
    assert BoardFinder(BOARD).find(noise) is None


@pytest.mark.parametrize("optics", [MILD, STRONG, NEAR])
def test_the_focal_length_and_the_middle_come_out_as_they_are(optics: CameraModel):
    fit = solve_lens(projected_views(optics, NOISE, 1))
    assert fit.lens.fx == pytest.approx(optics.fx, rel=2e-3)
    assert fit.lens.fy == pytest.approx(optics.fy, rel=2e-3)
    assert (fit.lens.cx, fit.lens.cy) == pytest.approx((optics.cx, optics.cy), abs=2.0)
    assert fit.residual == pytest.approx(NOISE * np.sqrt(2.0), rel=0.1)
    assert fit.lens.error < 0.01
    assert not fit.dropped


def test_a_view_that_does_not_agree_with_the_others_is_left_out_and_named():
    views = projected_views(MILD, NOISE, 2)
    shaken = np.random.default_rng(3).normal(0.0, 1.0, views[4].pixels.shape)
    views[4] = replace(views[4], pixels=views[4].pixels + shaken)
    fit = solve_lens(views)
    assert fit.views == len(views) - 1
    assert fit.dropped == ("view 5 was left out: it does not agree with the others (did the board move?)",)
    assert fit.residual < 0.1


def test_too_few_views_are_refused_with_what_to_do():
    with pytest.raises(CalibrationError, match="at least 6 different views of the board, got 3: tilt it"):
        solve_lens(projected_views(MILD, NOISE, 1)[:3])


def test_views_that_are_all_flat_are_refused_because_they_do_not_tell_the_focal_length():
    shifts = [(0.0, 0.0), (0.2, 0.0), (-0.2, 0.0), (0.0, 0.2), (0.0, -0.2), (0.1, 0.1), (-0.1, 0.1)]
    alike = [
        projected(MILD, Holding((0.0, 0.0, 20.0 * number), shift, 0.0), NOISE, number)
        for number, shift in enumerate(shifts)
    ]
    with pytest.raises(CalibrationError, match="too alike; add views with the board tilted"):
        solve_lens(alike)


def test_views_of_two_sizes_are_refused():
    views = projected_views(MILD, NOISE, 1)
    views[0] = replace(views[0], size=(320, 240))
    with pytest.raises(CalibrationError, match="one size"):
        solve_lens(views)


def test_a_board_that_is_bent_is_no_calibration():
    views = []
    for view in projected_views(MILD, NOISE, 1):
        bow = 4000.0 * view.places[:, :1] ** 2 * np.random.default_rng(len(views)).normal(size=2)
        views.append(replace(view, pixels=view.pixels + bow))
    with pytest.raises(CalibrationError, match="is the board"):
        solve_lens(views)


# Gathering -------------------------------------------------------------------------------------------


def views_of(optics: CameraModel) -> Views:
    return Views(Lens.of(optics))


def test_a_view_too_like_an_earlier_one_is_not_taken():
    views = views_of(MILD)
    assert views.offer(flat(MILD, NOISE, 1)) == ""
    assert "too much like" in views.offer(flat(MILD, NOISE, 2))
    assert views.offer(projected(MILD, HELD[1], NOISE, 3)) == ""
    assert len(views.taken) == 2


def test_the_hints_lead_to_enough_views_whoever_follows_them():
    """A person who does what is said: raises the named side, else holds the board some other way."""
    sides = {
        "left": (0.0, 25.0, 0.0),
        "right": (0.0, -25.0, 0.0),
        "upper": (25.0, 0.0, 0.0),
        "lower": (-25.0, 0.0, 0.0),
    }
    views, said = views_of(MILD), []
    for turn in range(30):
        said.append(views.hint)
        if views.is_enough:
            break
        tilt = next((tilt for side, tilt in sides.items() if f"raise its {side}" in views.hint), None)
        another = Holding(tilt or (0.0, 0.0, 25.0 * turn), (0.0, 0.0), 0.1 if tilt else 0.02 * turn)
        views.offer(projected(MILD, FLAT if not views.taken else another, NOISE, turn))
    assert views.is_enough
    assert len(views.taken) == ENOUGH_VIEWS
    assert said[0] == "lay the board flat under the camera"
    assert {f"raise its {side} side by a hand's width" for side in sides} <= set(said)
    assert solve_lens(views.taken).lens.error < 0.05


def test_a_part_of_the_picture_without_corners_is_asked_for():
    small = projected_views(MILD, NOISE, 1)
    views = views_of(MILD)
    for view in small:
        left = view.pixels[:, 0] < 300.0
        views.offer(
            replace(view, numbers=view.numbers[left], places=view.places[left], pixels=view.pixels[left])
        )
    assert views.coverage < 0.6
    assert views.hint == "move it to the right edge of the picture"


def test_a_picture_of_another_size_is_not_taken():
    views = views_of(MILD)
    assert "size has changed" in views.offer(replace(flat(MILD, NOISE, 1), size=(320, 240)))


def test_a_board_stands_still_when_only_noise_moves_its_corners():
    one = flat(MILD, NOISE, 1)
    assert stands_still(one, flat(MILD, NOISE, 2))
    assert not stands_still(one, replace(one, pixels=one.pixels + 0.8))
    assert not stands_still(None, one)
    assert moved(one, replace(one, numbers=one.numbers + 1000)) is None
