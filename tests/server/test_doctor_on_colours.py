"""`pivotrig doctor` on the robot's colour: one blob, none, several, and how well it stands out."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from control.model import PIVOT_A, Body, Frame, Pose
from server.cli import app
from server.diagnosis.check import Check
from server.diagnosis.colour import examine
from server.settings import RigFile
from vision.camera_model import CameraModel
from vision.simulated.rendering import Painter, SceneSettings

OPTICS = CameraModel.looking_down()
BESIDE = Body(Pose(0.02, -0.02, 0.4), PIVOT_A, 0.0)
OTHER = Body(Pose(-0.03, 0.02, 1.4), PIVOT_A, 0.0)


def frame(image: np.ndarray) -> Frame:
    return Frame(image, 0.0, 0)


def plate(body: Body | None, **scene) -> np.ndarray:
    return Painter(OPTICS, SceneSettings(**scene)).paint(body, 3)


def two_robots() -> np.ndarray:
    image, other = plate(BESIDE).copy(), plate(OTHER)
    u, v = (round(place) for place in OPTICS.to_pixel(OTHER.pose.x, OTHER.pose.y, 0.003))
    image[v - 24 : v + 24, u - 24 : u + 24] = other[v - 24 : v + 24, u - 24 : u + 24]
    return image


@pytest.mark.parametrize(
    ("image", "level", "words"),
    [
        (plate(BESIDE), "ok", "in one blob; 100 % separated"),
        (plate(None), "warning", "no blob is as large as the robot"),
        (two_robots(), "warning", "2 blobs look like the robot"),
        (np.full((240, 320, 3), 90, np.uint8), "warning", "another size"),
    ],
)
def test_a_picture_is_judged_by_the_blobs_of_the_robot_s_colour(image: np.ndarray, level: str, words: str):
    check: Check = examine(frame(image), RigFile())
    assert check.level == level
    assert words in check.finding
    assert bool(check.advice) == (level == "warning")


def test_a_robot_that_hardly_stands_out_is_told():
    grey = RigFile.model_validate({"vision": {"hue_deg": [0, 360], "saturation": [0, 255], "value": [0, 60]}})
    scene = {"light_gradient": 0.0, "shadow_strength": 0.0, "plate": (75.0, 75.0, 75.0)}
    check = examine(frame(plate(BESIDE, colour=(40.0, 40.0, 40.0), noise=4.0, **scene)), grey)
    assert check.level == "warning"
    assert "in one blob" in check.finding
    assert "background of another colour" in check.advice


def test_the_doctor_says_it_of_a_simulated_rig(tmp_path: Path):
    said = json.loads(CliRunner().invoke(app, ["doctor", "--json", "--data", str(tmp_path)]).stdout)
    found = {check["name"]: check for check in said["checks"]}
    assert found["robot's colour"]["level"] == "ok"
    assert "in one blob" in found["robot's colour"]["finding"]
