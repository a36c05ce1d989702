"""The plane: positions to a hundredth of a millimetre, and a residual that says how far off they are."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scripted_board import HALF, MILD, NEAR, STRONG, flat, projected_views, rendered, true_error

from vision.calibration.lens import Lens, solve_lens
from vision.calibration.plane import PlaneFit, plane_from_board, plane_from_corners, plane_from_marks
from vision.camera_model import CalibrationError, CameraModel
from vision.simulated.held_board import FLAT, HELD

NOISE = 0.03
"""Of a corner found in a rendered picture, px."""
CLICK = 0.5
"""Of a person's click, px."""
HONEST = 0.30
"""The reported residual is within this of the true error, RMS over the seeds."""
ALLOWED = 0.05e-3
"""RMS error of positions after a calibration by the board, m."""


def rms(values: list[float]) -> float:
    return math.sqrt(float(np.mean(np.square(values))))


def compared(calibrate: Callable[[int], PlaneFit], optics: CameraModel, seeds: int) -> tuple[float, float]:
    """True error and reported residual, RMS over the seeds, m."""
    fits = [calibrate(seed) for seed in range(seeds)]
    return rms([true_error(fit.model, optics) for fit in fits]), rms([fit.residual for fit in fits])


# From the board ----------------------------------------------------------------------------------------


def test_rendered_boards_through_a_lens_give_positions_to_a_twentieth_of_a_millimetre_and_say_how_well(
    full: bool,
):
    for optics in (MILD, STRONG, NEAR) if full else (STRONG,):
        sets = rendered(optics, (*HELD[: 10 if full else 7], FLAT), 12 if full else 4)
        lenses = [solve_lens(sightings[:-1]).lens for sightings in sets]

        def calibrate(seed: int, lenses: list[Lens] = lenses, sets=sets) -> PlaneFit:
            return plane_from_board(lenses[seed], sets[seed][-1], HALF)

        true, reported = compared(calibrate, optics, len(sets))
        assert true < 0.1 * ALLOWED
        assert reported == pytest.approx(true, rel=HONEST)


@pytest.mark.parametrize(("optics", "noise"), [(MILD, 0.3), (STRONG, NOISE), (NEAR, NOISE), (NEAR, 0.3)])
def test_the_residual_is_honest_whatever_the_lens_and_the_noise(
    optics: CameraModel, noise: float, full: bool
):
    def calibrate(seed: int) -> PlaneFit:
        lens = solve_lens(projected_views(optics, noise, seed)).lens
        return plane_from_board(lens, flat(optics, noise, seed), HALF)

    true, reported = compared(calibrate, optics, 60 if full else 8)
    assert reported == pytest.approx(true, rel=HONEST)
    assert true < ALLOWED


def test_the_residual_is_honest_of_a_lens_that_was_assumed_and_is_another():
    straight = replace(Lens.of(MILD), distortion=(0.0, 0.0, 0.0, 0.0, 0.0))
    bent = CameraModel.looking_down(distortion=(-0.06, 0.0, 0.0, 0.0, 0.0))
    true, reported = compared(lambda seed: plane_from_board(straight, flat(bent, NOISE, seed), HALF), bent, 5)
    assert true > 0.02e-3
    assert reported == pytest.approx(true, rel=HONEST)


def test_the_middle_of_the_board_becomes_the_origin_and_its_directions_the_axes():
    fit = plane_from_board(Lens.of(STRONG), flat(STRONG, 0.0, 1), HALF)
    assert true_error(fit.model, STRONG) < 1e-8
    assert fit.residual < 1e-7
    assert fit.model.to_pixel(0.0, 0.0) == pytest.approx(STRONG.to_pixel(0.0, 0.0), abs=1e-4)
    assert fit.camera_height == pytest.approx(0.35 * math.cos(0.08) * math.cos(0.05), rel=1e-6)
    assert fit.tilt == pytest.approx(math.acos(math.cos(0.08) * math.cos(0.05)), rel=1e-6)


def test_a_board_with_a_thickness_still_gives_the_plate():
    thick = 0.004
    seen = flat(MILD, 0.0, 1)
    raised = replace(seen, pixels=MILD.to_image(seen.places, thick))
    fit = plane_from_board(Lens.of(MILD), raised, HALF, thick)
    assert true_error(fit.model, MILD) < 1e-7
    assert true_error(plane_from_board(Lens.of(MILD), raised, HALF).model, MILD) > 0.3e-3


def test_the_top_of_a_robot_above_the_plate_is_placed_as_well_as_the_plate():
    lens = solve_lens(projected_views(STRONG, NOISE, 4)).lens
    model = plane_from_board(lens, flat(STRONG, NOISE, 4), HALF).model
    places = np.array([(x, y) for x in (-0.05, 0.0, 0.05) for y in (-0.05, 0.0, 0.05)])
    away = model.to_workspace(STRONG.to_image(places, 0.006), 0.006) - places
    assert np.abs(away).max() < ALLOWED


def test_a_picture_of_another_size_than_the_lens_s_is_refused_with_both():
    other = replace(flat(MILD, NOISE, 1), size=(1280, 720))
    with pytest.raises(CalibrationError, match="640 x 480 px and this one has 1280 x 720 px"):
        plane_from_board(Lens.of(MILD), other, HALF)


def test_a_board_of_another_shape_than_was_said_is_refused():
    seen = flat(MILD, NOISE, 1)
    with pytest.raises(CalibrationError, match="is its square size right"):
        plane_from_board(Lens.of(MILD), replace(seen, places=seen.places * (1.0, 1.05)), HALF)


# From clicks -------------------------------------------------------------------------------------------

CORNERS = np.array([(-0.05, 0.04), (0.05, 0.04), (0.05, -0.04), (-0.05, -0.04)])


def clicked(places: np.ndarray, optics: CameraModel, noise: float, seed: int) -> np.ndarray:
    return optics.to_image(places) + np.random.default_rng(seed).normal(0.0, noise, places.shape)


def test_four_exact_corners_give_the_plane_exactly():
    fit = plane_from_corners(Lens.of(STRONG), clicked(CORNERS, STRONG, 0.0, 1), (0.1, 0.08), HALF)
    assert true_error(fit.model, STRONG) < 1e-7
    assert "four corners hardly check each other" in fit.remarks[0]


def test_corners_may_be_clicked_in_any_order_from_the_first():
    pixels = clicked(CORNERS, MILD, 0.0, 1)
    for order in itertools.permutations((1, 2, 3)):
        fit = plane_from_corners(Lens.of(MILD), pixels[[0, *order]], (0.1, 0.08), HALF)
        assert true_error(fit.model, MILD) < 1e-7


def test_the_residual_of_four_clicks_is_what_clicks_are_worth():
    lens = Lens.of(MILD)

    def calibrate(seed: int) -> PlaneFit:
        return plane_from_corners(lens, clicked(CORNERS, MILD, CLICK, seed), (0.1, 0.08), HALF)

    true, reported = compared(calibrate, MILD, 100)
    assert reported == pytest.approx(true, rel=HONEST)


@pytest.mark.parametrize("noise", [0.2, 0.5, 1.5])
def test_the_residual_of_many_marks_is_honest(noise: float, full: bool):
    lens, places = Lens.of(STRONG), np.random.default_rng(5).uniform(-0.055, 0.055, (16, 2))

    def calibrate(seed: int) -> PlaneFit:
        return plane_from_marks(lens, clicked(places, STRONG, noise, seed), places, HALF)

    true, reported = compared(calibrate, STRONG, 60 if full else 12)
    assert reported == pytest.approx(true, rel=HONEST)


def test_a_mark_that_is_wrong_is_named():
    places = np.random.default_rng(6).uniform(-0.055, 0.055, (9, 2))
    pixels = clicked(places, MILD, 0.3, 1)
    pixels[3] += (8.0, -6.0)
    fit = plane_from_marks(Lens.of(MILD), pixels, places, HALF)
    assert len(fit.remarks) == 1
    assert fit.remarks[0].startswith("mark 4 is ")
    assert "look at it again" in fit.remarks[0]
    assert not plane_from_marks(Lens.of(MILD), clicked(places, MILD, 0.3, 1), places, HALF).remarks


@pytest.mark.parametrize(
    ("pixels", "rectangle", "words"),
    [
        (np.array([(0.0, 0.0), (1.0, 1.0), (2.0, 2.0), (3.0, 3.0)]), (0.1, 0.1), "on one line"),
        (np.array([(0.0, 0.0), (100.0, 0.0), (100.0, math.nan), (0.0, 100.0)]), (0.1, 0.1), "finite"),
        (np.array([(0.0, 0.0), (100.0, 0.0), (100.0, 100.0)]), (0.1, 0.1), "four corners, got 3"),
        (MILD.to_image(CORNERS), (0.1, 0.0), "wider and higher than 0 mm"),
        (MILD.to_image(CORNERS), (0.1, math.nan), "wider and higher than 0 mm"),
        (MILD.to_image(CORNERS), (0.1, 0.02), "measures right"),
    ],
)
def test_corners_that_make_no_plane_are_refused_with_words(
    pixels: np.ndarray, rectangle: tuple[float, float], words: str
):
    with pytest.raises(CalibrationError, match=words):
        plane_from_corners(Lens.of(MILD), pixels, rectangle, HALF)


def test_marks_that_make_no_plane_are_refused_with_words():
    line = np.array([(x, 0.0) for x in np.linspace(-0.05, 0.05, 6)])
    with pytest.raises(CalibrationError, match="on one line"):
        plane_from_marks(Lens.of(MILD), MILD.to_image(line), line, HALF)
    with pytest.raises(CalibrationError, match="at least 4 marks, got 3"):
        plane_from_marks(Lens.of(MILD), MILD.to_image(CORNERS[:3]), CORNERS[:3], HALF)
    swapped = CORNERS[[0, 1, 3, 2]] * (1.0, 1.0)
    with pytest.raises(CalibrationError, match="in order"):
        plane_from_marks(Lens.of(MILD), MILD.to_image(CORNERS), swapped, HALF)


def test_a_line_of_marks_and_one_beside_it_are_refused_for_they_fit_two_cameras():
    places = np.array([(-0.05, 0.0), (-0.02, 0.0), (0.02, 0.0), (0.05, 0.0), (0.0, 0.05)])
    for marks in (places, places[[0, 2, 3, 4]]):
        with pytest.raises(CalibrationError, match=f"all points but number {len(marks)} are on one line"):
            plane_from_marks(Lens.of(MILD), clicked(marks, MILD, CLICK, 1), marks, HALF)
    enough = np.vstack([places, [(0.0, -0.05)]])
    plane_from_marks(Lens.of(MILD), clicked(enough, MILD, CLICK, 1), enough, HALF)


def test_marks_without_any_noise_are_no_suspects():
    places = np.array([(-0.05, -0.05), (0.05, -0.05), (0.05, 0.05), (-0.05, 0.05)] * 2)
    assert plane_from_marks(Lens.of(MILD), clicked(places, MILD, 0.0, 1), places, HALF).remarks == ()


def test_whatever_is_clicked_gives_a_plane_or_words(full: bool):
    chance = np.random.default_rng(5)
    for _ in range(400 if full else 60):
        count = int(chance.integers(4, 9))
        pixels = chance.uniform(-1e4, 1e4, (count, 2)), 200.0 * chance.integers(0, 3, (count, 2))
        places = chance.uniform(-2.0, 2.0, (count, 2)), 1e-6 * chance.integers(-1, 2, (count, 2))
        for seen, known in itertools.product(pixels, places):
            try:
                fit = plane_from_marks(Lens.of(STRONG), seen.astype(float), known.astype(float), HALF)
            except CalibrationError:
                continue
            assert math.isfinite(fit.residual)
            assert np.isfinite(fit.model.to_image(np.array([(0.0, 0.0), (HALF, HALF)]))).all()


def test_arrays_in_any_layout_give_the_same_plane():
    table = np.column_stack([MILD.to_image(CORNERS), CORNERS])
    one = plane_from_marks(Lens.of(MILD), table[:, :2], table[:, 2:], HALF)
    other = plane_from_marks(
        Lens.of(MILD), np.asfortranarray(table[:, :2]), np.asfortranarray(table[:, 2:]), HALF
    )
    assert one == other
    assert true_error(one.model, MILD) < 1e-7


def test_a_pattern_as_symmetrical_as_the_view_of_it_is_no_obstacle():
    places = np.vstack([CORNERS, (0.0, 0.0)])
    fit = plane_from_marks(Lens.of(MILD), np.round(MILD.to_image(places), 3), places, HALF)
    assert true_error(fit.model, MILD) < 1e-6
    straight = CameraModel.looking_down(tilt=(0.0, 0.0))
    fit = plane_from_marks(Lens.of(straight), straight.to_image(places), places, HALF)
    assert true_error(fit.model, straight) < 1e-6
