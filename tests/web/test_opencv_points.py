"""The page's camera is held against points that OpenCV has computed: those are up to date."""

import json

import numpy as np

from tests.web import opencv_camera


def test_the_points_are_those_of_this_opencv() -> None:
    kept, now = json.loads(opencv_camera.FILE.read_text()), opencv_camera.table()
    assert kept.keys() == now.keys()
    for name, camera in now.items():
        assert kept[name]["places_mm"] == camera["places_mm"]
        np.testing.assert_allclose(kept[name]["points_px"], camera["points_px"], rtol=0.0, atol=1e-6)
