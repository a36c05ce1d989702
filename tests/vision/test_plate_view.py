import numpy as np
import pytest

from vision.camera_model import CameraModel
from vision.plate_view import OUTSIDE, PlateView

SIDE, HALF = 261, 0.065
CAMERA = CameraModel.looking_down(tilt=(0.05, -0.03))


def spotted(x, y):
    """A picture with one bright spot at a point of the plate, m."""
    image = np.zeros((480, 640, 3), np.uint8)
    u, v = CAMERA.to_pixel(x, y)
    image[round(v) - 2 : round(v) + 3, round(u) - 2 : round(u) + 3] = 255
    return image


@pytest.mark.parametrize("point", [(0.0, 0.0), (0.04, 0.03), (-0.05, 0.02), (0.01, -0.05)])
def test_a_spot_on_the_plate_is_where_it_would_be_from_above(point):
    seen = PlateView(CAMERA, HALF, SIDE).of(spotted(*point))
    rows, columns = np.nonzero(seen[..., 0] > 200)
    step = 2.0 * HALF / (SIDE - 1)
    assert columns.mean() * step - HALF == pytest.approx(point[0], abs=step)
    assert HALF - rows.mean() * step == pytest.approx(point[1], abs=step)


def test_what_the_camera_does_not_see_is_grey():
    seen = PlateView(CAMERA, 0.2, 64).of(np.full((480, 640, 3), 255, np.uint8))
    assert tuple(seen[0, 0]) == OUTSIDE
    assert tuple(seen[32, 32]) == (255, 255, 255)


def test_a_picture_of_another_camera_is_refused():
    with pytest.raises(ValueError, match="640 x 480 px, got one of 320 x 240 px"):
        PlateView(CAMERA, HALF, SIDE).of(np.zeros((240, 320, 3), np.uint8))
