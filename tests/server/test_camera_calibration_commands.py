"""`pivotrig calibrate board | lens | plane` on the simulated rig."""

import json
from pathlib import Path

import cv2
import numpy as np
import pytest
from typer.testing import CliRunner

from server.calibration.optics import assumed_model, model_in_use
from server.cli import app
from server.rig_file import load_rig_file
from server.settings import RigFile
from vision.calibration.board import Board
from vision.simulated.held_board import held_board
from vision.simulated.rendering import Painter, SceneSettings

OPTICS = assumed_model(RigFile().camera)
VIEWS = 6
SMALL = """
[camera]
size_px = [320, 240]
[camera.board]
columns = 8
rows = 8
square_mm = 16.0
"""
"""A rig whose pictures are drawn soon, and a board that is found in them."""


def calibrate(*arguments: str):
    return CliRunner().invoke(app, ["calibrate", *arguments])


@pytest.fixture
def rig(tmp_path: Path) -> Path:
    path = tmp_path / "rig.toml"
    path.write_text("# mine\nversion = 1\n")
    return path


@pytest.fixture(scope="module")
def pictures(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Of the board as a person holds it, as files."""
    folder = tmp_path_factory.mktemp("pictures")
    painter = Painter(OPTICS, SceneSettings())
    for number in range(VIEWS):
        painter.show_board(held_board(Board(), OPTICS, number))
        cv2.imwrite(str(folder / f"view {number}.png"), painter.paint(None, number))
    return folder


def test_pictures_give_the_lens_and_the_flat_board_the_plane_and_both_are_saved(rig: Path, pictures: Path):
    lens = calibrate("lens", "--images", str(pictures), "--save", "--rig", str(rig), "--json")
    assert lens.exit_code == 0, lens.output
    assert json.loads(lens.stdout)["views"] == VIEWS
    plane = calibrate("plane", "--save", "--rig", str(rig), "--json")
    assert plane.exit_code == 0, plane.output
    assert json.loads(plane.stdout)["residual_mm"] < 0.01
    assert "# mine" in rig.read_text()
    camera = load_rig_file(rig).camera
    assert camera.lens is not None
    assert camera.plane is not None
    assert camera.plane.lens_date == camera.lens.date
    places = np.array([(x, y) for x in (-0.06, 0.0, 0.06) for y in (-0.06, 0.0, 0.06)])
    assert np.abs(model_in_use(camera).to_workspace(OPTICS.to_image(places)) - places).max() < 0.02e-3


def test_a_live_simulated_camera_is_shown_the_board_until_the_views_suffice(rig: Path):
    rig.write_text(SMALL)
    answer = calibrate("lens", "--rig", str(rig))
    assert answer.exit_code == 0, answer.output
    assert "10 views at 320 x 240 px" in answer.stdout
    assert "[camera.lens]" in answer.stdout
    assert "plane" not in answer.stdout.split("[camera.lens]")[1]
    assert load_rig_file(rig).camera.lens is None


def test_corners_and_marks_are_given_in_pixels_and_millimetres(rig: Path):
    def seen(x: float, y: float) -> str:
        u, v = OPTICS.to_pixel(x * 1e-3, y * 1e-3)
        return f"{u:.3f},{v:.3f}"

    corners = [(-50, 40), (50, 40), (50, -40), (-50, -40)]
    options = [option for corner in corners for option in ("--corner", seen(*corner))]
    size = ("--width-mm", "100", "--height-mm", "80")
    answer = calibrate("plane", "--method", "corners", *options, *size, "--rig", str(rig), "--json")
    assert json.loads(answer.stdout)["height_mm"] == pytest.approx(350.0, abs=0.5)
    marks = [
        option for x, y in [*corners, (0, 0), (10, 20)] for option in ("--mark", f"{seen(x, y)},{x},{y}")
    ]
    answer = calibrate("plane", "--method", "marks", *marks, "--rig", str(rig))
    assert answer.exit_code == 0, answer.output
    assert "positions over the workspace are known to 0.00" in answer.stdout
    assert "the lens is not calibrated" in answer.stdout
    assert "[camera.plane]" in answer.stdout


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("plane", "--method", "corners"), "give --corner U,V four times"),
        (("plane", "--method", "marks"), "give --mark U,V,X,Y at least four times"),
        (("plane", "--method", "marks", "--mark", "1,2,3"), "takes 4 finite numbers"),
        (("plane", "--method", "marks", "--mark", "1,2,nan,4"), "takes 4 finite numbers"),
        (("plane", "--method", "marks", "--mark", "1,2,3,4"), "at least 4 marks, got 1"),
        (("board", "--square-mm", "0.1"), "greater than or equal to 3"),
        (("lens", "--images", "/nowhere"), "cannot be read"),
    ],
)
def test_wrong_options_end_with_what_is_needed(
    rig: Path, tmp_path: Path, arguments: tuple[str, ...], words: str
):
    out = ("--out", str(tmp_path / "board.pdf")) if arguments[0] == "board" else ()
    answer = calibrate(*arguments, *out, "--rig", str(rig))
    assert answer.exit_code in (2, 3)
    assert words in answer.stderr


def test_a_board_of_another_size_is_written_and_becomes_the_rig_s(rig: Path, tmp_path: Path):
    out = tmp_path / "board.pdf"
    answer = calibrate(
        "board", "--columns", "10", "--square-mm", "15", "--out", str(out), "--save", "--rig", str(rig)
    )
    assert answer.exit_code == 0, answer.output
    assert b"10 x 12 squares of 15 mm" in out.read_bytes()
    board = load_rig_file(rig).camera.board
    assert (board.columns, board.rows, board.square_mm) == (10, 12, 15.0)
    nowhere = calibrate("board", "--out", str(tmp_path / "no" / "board.pdf"), "--rig", str(rig))
    assert nowhere.exit_code == 1
    assert "cannot write" in nowhere.stderr
