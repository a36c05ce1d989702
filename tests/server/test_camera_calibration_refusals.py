"""What a calibration of the camera does not take: a moving board, another camera's, marks and bodies that are none."""

import asyncio
import itertools
import threading

import numpy as np
import pytest
from calibration_visit import PATIENCE, wizard

from control.safety import Refused
from server.assembly import build_machine
from server.calibration import camera as camera_calibration
from server.calibration.camera import CameraCalibration
from server.calibration.optics import assumed_model, board_of
from server.rig import Rig
from server.settings import RigFile
from vision.calibration.plane import plane_from_corners
from vision.simulated.camera import SyntheticCamera
from vision.simulated.held_board import Holding, shown_board

pytestmark = pytest.mark.anyio

CORNERS = np.array([(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)])


@pytest.mark.parametrize(
    "body",
    [
        {},
        {"method": "guess"},
        {"method": "corners", "points_px": [[1.0, 2.0]] * 3, "width_mm": 10.0, "height_mm": 10.0},
        {"method": "corners", "points_px": [[1.0, 2.0]] * 4, "width_mm": -1.0, "height_mm": 10.0},
        {"method": "corners", "points_px": [[1e9, 2.0]] * 4, "width_mm": 1.0, "height_mm": 10.0},
        {"method": "marks", "marks": [{"u": 1.0, "v": 2.0, "x_mm": 3.0}] * 4},
        {"method": "board", "thickness": 3},
    ],
)
async def test_bodies_that_are_no_plane_are_refused_whole(api, body):
    answer = await api.post("/calibration/plane", json=body)
    assert answer.status_code == 422
    assert answer.json()["errors"]


async def test_the_board_is_not_shown_and_nothing_saved_while_the_rig_is_armed(serve, tmp_path):
    async with wizard(serve, tmp_path / "rig.toml") as page:
        await page.show("flat")
        await page.ask("POST", "/calibration/plane", method="board")
        await page.show(shown=False)
        await page.until(lambda state: state["tracking"] == "locked" and not state["faults"])
        await page.ask("POST", "/arm")
        assert "disarm" in (await page.ask("PUT", "/simulation/board", 409, shown=True))["detail"]
        assert "disarmed" in (await page.ask("POST", "/calibration/save", 409))["detail"]
        await page.ask("POST", "/disarm")
        await page.ask("POST", "/calibration/save")


async def test_the_board_can_be_taken_away_in_any_state_and_whoever_asks_is_told_of_it(serve, tmp_path):
    async def shown(page):
        return (await page.ask("GET", "/calibration"))["session"]["board_shown"]

    async with wizard(serve, tmp_path / "rig.toml") as page:
        assert await shown(page) is None
        await page.show("next")
        assert await shown(page) == "next"
        await page.ask("POST", "/estop")
        await page.until(lambda state: state["rig"] == "fault")
        assert "disarm" in (await page.ask("PUT", "/simulation/board", 409, shown=True))["detail"]
        await page.show(shown=False)
        assert await shown(page) is None
        await page.until(lambda state: state["tracking"] == "locked")
        await page.ask("POST", "/reset")
        await page.show("flat")
        await page.ask("PATCH", "/rig", camera={"height_mm": 340.0})
        assert await shown(page) is None, "the rebuilt camera has not seen it"


async def test_a_board_that_moves_is_no_view_and_no_plane(serve, tmp_path, monkeypatch):
    # Drawing the board anew for each picture takes a busy computer long.
    monkeypatch.setattr(camera_calibration, "OLDEST_PICTURE", 20.0)
    async with wizard(serve, tmp_path / "rig.toml") as page:
        camera, settings = page.rig.machine.camera, page.rig.settings.camera
        assert isinstance(camera, SyntheticCamera)
        views = [
            shown_board(
                board_of(settings), assumed_model(settings), Holding((0.0, 0.0, 0.0), (shift, 0.0), 0.0)
            )
            for shift in (0.0, 0.01)
        ]
        turns = itertools.cycle(views)
        with page.rig.watched(lambda _: camera.show_board(next(turns))):
            await page.show("flat")
            look = await page.ask("POST", "/calibration/lens/views")
            refused = await page.ask("POST", "/calibration/plane", 422, method="board")
        assert (look["taken"], look["views"]) == (False, 0)
        assert "hold it still" in look["hint"]
        assert "hold it still" in refused["detail"]


async def test_what_was_worked_out_for_another_camera_is_not_taken_for_this_one_s():
    rig = Rig(build_machine(RigFile(), realtime=True))
    await rig.start()
    try:
        calibration = CameraCalibration(rig)
        begun, go_on = threading.Event(), threading.Event()

        def solve(lens, workspace):
            begun.set()
            assert go_on.wait(PATIENCE)
            pixels = assumed_model(RigFile().camera).to_image(0.05 * CORNERS)
            return plane_from_corners(lens, pixels, (0.1, 0.1), workspace)

        work = asyncio.create_task(calibration.solve_plane(solve))
        await asyncio.to_thread(begun.wait, PATIENCE)
        await rig.rebuild(RigFile.model_validate({"camera": {"size_px": [320, 240]}}))
        go_on.set()
        with pytest.raises(Refused, match="have changed meanwhile"):
            await work
        assert calibration.plane is None
    finally:
        await rig.stop()


async def test_marks_of_every_kind_are_a_plane_or_refused_in_words(api):
    """None of them is an error of the server's: a line and one beside it, the same one again, far outside."""
    beside = [(x, 0.0) for x in (-50.0, -20.0, 20.0, 50.0)] + [(0.0, 50.0)]
    again = [(-50.0, -50.0), (50.0, -50.0), (50.0, 50.0), (-50.0, 50.0)] * 50
    far = [(x * 40.0, y * 40.0) for x, y in again]
    for places in (beside, again, far):
        marks = [{"u": 320.0 + 3.0 * x, "v": 240.0 - 3.0 * y, "x_mm": x, "y_mm": y} for x, y in places]
        answer = await api.post("/calibration/plane", json={"method": "marks", "marks": marks})
        assert answer.status_code in (200, 422), answer.text
        assert answer.status_code == 200 or "on one line" in answer.json()["detail"]
    too_many = {"method": "marks", "marks": [{"u": 1.0, "v": 1.0, "x_mm": 1.0, "y_mm": 1.0}] * 201}
    assert (await api.post("/calibration/plane", json=too_many)).status_code == 422
    no_number = '{"method": "marks", "marks": [{"u": NaN, "v": 1.0, "x_mm": 1.0, "y_mm": 1.0}]}'
    headers = {"Content-Type": "application/json"}
    assert (await api.post("/calibration/plane", content=no_number, headers=headers)).status_code == 422
