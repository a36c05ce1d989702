from __future__ import annotations

import dataclasses
import math

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scripted_scene import OPTICS

from vision.camera_model import CalibrationError, CameraModel

STRONG_LENS = CameraModel.looking_down(tilt=(0.1, -0.15), distortion=(-0.3, 0.09, 0.002, -0.001, -0.01))
place = st.floats(-0.065, 0.065)
above = st.floats(0.0, 0.02)


@given(place, place, above)
def test_a_point_projected_and_mapped_back_is_where_it_was_at_any_height(x: float, y: float, height: float):
    for model in (OPTICS, STRONG_LENS):
        u, v = model.to_pixel(x, y, height)
        assert np.allclose(model.to_point(u, v, height), (x, y), atol=1e-6, rtol=0)


def test_many_points_at_once_go_the_way_that_single_points_go():
    points = np.random.default_rng(1).uniform(-0.06, 0.06, (50, 2))
    image = STRONG_LENS.to_image(points, 0.003)
    singly = [STRONG_LENS.to_pixel(x, y, 0.003) for x, y in points]
    assert np.allclose(image, singly, atol=1e-9)
    assert np.allclose(STRONG_LENS.to_workspace(image, 0.003), points, atol=1e-9)
    assert OPTICS.to_image(np.empty((0, 2))).shape == OPTICS.to_workspace(np.empty((0, 2))).shape == (0, 2)


def test_the_projection_is_the_one_of_opencv():
    points = np.random.default_rng(2).uniform(-0.06, 0.06, (50, 2))
    model = STRONG_LENS
    turn, _ = cv2.Rodrigues(np.array(model.rotation))
    pinhole = np.array([[model.fx, 0, model.cx], [0, model.fy, model.cy], [0, 0, 1]])
    spatial = np.column_stack([points, np.full(50, 0.004)])
    seen, _ = cv2.projectPoints(
        spatial, turn, np.array(model.translation), pinhole, np.array(model.distortion)
    )
    assert np.allclose(model.to_image(points, 0.004), seen[:, 0], atol=1e-8)


def test_in_the_picture_x_goes_right_and_y_goes_up_and_the_centre_is_in_the_middle():
    assert OPTICS.to_pixel(0.0, 0.0) == pytest.approx((319.5, 239.5))
    assert OPTICS.to_pixel(0.01, 0.0)[0] > 350.0
    assert OPTICS.to_pixel(0.0, 0.01)[1] < 210.0


def test_the_whole_workspace_is_in_the_default_picture_with_room_for_the_robot():
    corners = np.array([(x, y) for x in (-0.06, 0.06) for y in (-0.06, 0.06)])
    seen = OPTICS.to_image(corners, 0.003)
    assert (seen > 12.0).all()
    assert (seen < np.array(OPTICS.size) - 12.0).all()


def test_a_higher_point_is_seen_further_from_the_middle():
    flat, raised = OPTICS.to_pixel(0.05, 0.0), OPTICS.to_pixel(0.05, 0.0, 0.003)
    assert raised[0] - flat[0] == pytest.approx(0.05 * 0.003 / 0.35 * 3692, rel=0.1)


def test_the_local_scale_is_that_of_a_small_step():
    u0, _ = OPTICS.to_pixel(0.0, 0.0)
    u1, _ = OPTICS.to_pixel(0.001, 0.0)
    assert OPTICS.scale_at(0.0, 0.0) == pytest.approx((u1 - u0) / 0.001, rel=1e-3)


@pytest.mark.parametrize(
    "wrong",
    [
        {"fx": math.nan},
        {"fy": 0.0},
        {"size": (0, 480)},
        {"distortion": (math.inf, 0.0, 0.0, 0.0, 0.0)},
        {"rotation": ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, -1.0))},
        {"rotation": ((2.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))},
    ],
)
def test_an_impossible_calibration_is_refused(wrong: dict):
    with pytest.raises(CalibrationError):
        dataclasses.replace(OPTICS, **wrong)
