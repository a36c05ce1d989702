"""Lens and plane over REST, on the simulated rig with the printed board before its camera."""

import asyncio
import contextlib
import itertools
import threading

import httpx
import numpy as np
import pytest

from control.safety import Refused
from server.app import create_app
from server.assembly import build_machine
from server.camera_calibration import CameraCalibration
from server.optics import assumed_model, board_of
from server.rig import Rig
from server.rig_changes import RigChanges
from server.rig_file import RigStore, load_rig_file
from server.settings import RigFile
from vision.calibration.plane import plane_from_corners
from vision.simulated.held_board import Holding, shown_board

pytestmark = pytest.mark.anyio

PATIENCE = 30.0
ENOUGH = 7
"""Views: the lens needs 6."""
GRID = np.array([(x, y) for x in np.linspace(-0.06, 0.06, 7) for y in np.linspace(-0.06, 0.06, 7)])

CORNERS = np.array([(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)])


class Wizard:
    """Somebody at the page of a served rig with its file."""

    def __init__(self, rig, path, api):
        self.rig, self.path, self.api = rig, path, api

    async def ask(self, verb, path, status=200, /, **body):
        answer = await self.api.request(verb, path, json=body or None)
        assert answer.status_code == status, answer.text
        return answer.json()

    async def show(self, pose="flat", shown=True):
        return await self.ask("PUT", "/simulation/board", shown=shown, pose=pose)

    async def until(self, condition):
        async with asyncio.timeout(PATIENCE):
            while not condition(state := await self.ask("GET", "/state")):
                await asyncio.sleep(0.02)
        return state

    def position_error(self):
        """RMS over the workspace of where the rig places what its camera sees, m."""
        machine = self.rig.machine
        truth = assumed_model(machine.settings.camera)
        away = machine.camera_model.to_workspace(truth.to_image(GRID)) - GRID
        return float(np.sqrt(np.mean(np.sum(away**2, axis=1))))


@contextlib.asynccontextmanager
async def wizard(serve, path, as_run=lambda settings: settings):
    store = RigStore(path)
    rig = Rig(build_machine(as_run(store.settings), realtime=True))
    changes = RigChanges(rig, store, as_run)
    async with (
        serve(create_app(rig, changes=changes)) as at,
        httpx.AsyncClient(base_url=at.url + "/api/v1", timeout=PATIENCE) as api,
    ):
        yield Wizard(rig, path, api)


async def test_lens_and_plane_are_calibrated_saved_and_used_and_taken_out_again(serve, tmp_path):
    async with wizard(serve, tmp_path / "rig.toml") as page:
        empty = await page.ask("GET", "/calibration")
        assert (empty["lens"], empty["plane"], empty["session"]["views"]) == (None, None, 0)
        assert empty["session"]["hint"] == "lay the board flat under the camera"
        assert empty["board"] == {
            "columns": 14, "rows": 12, "square_mm": 12.0, "marker_mm": 9.0, "dictionary": "4X4_100",
            "thickness_mm": 0.0,
        }  # fmt: skip

        await page.show("flat")
        first = await page.ask("POST", "/calibration/lens/views")
        assert (first["taken"], first["views"], first["corners"]) == (True, 1, 143)
        assert len(first["corners_px"]) == 143
        again = await page.ask("POST", "/calibration/lens/views")
        assert (again["taken"], again["views"]) == (False, 1)
        assert "too much like" in again["why_not"]
        for _ in range(ENOUGH - 1):
            await page.show("next")
            assert (await page.ask("POST", "/calibration/lens/views"))["taken"]

        lens = (await page.ask("POST", "/calibration/lens"))["pending_lens"]
        assert lens["views"] == ENOUGH
        assert lens["residual_px"] < 0.1
        assert lens["error_px"] < 0.01
        await page.show("flat")
        plane = (await page.ask("POST", "/calibration/plane", method="board"))["pending_plane"]
        assert plane["source"] == "board"
        assert plane["lens"] == "new"
        assert 0.0 < plane["residual_mm"] < 0.01
        assert plane["height_mm"] == pytest.approx(350.0, abs=0.5)
        assert plane["tilt_deg"] == pytest.approx(1.5, abs=0.1)
        assert len(plane["outline_px"]) == 48
        assert not page.path.exists()

        saved = await page.ask("POST", "/calibration/save")
        for part in ("lens", "plane"):
            assert saved[part]["identity"] == "simulated camera"
            assert saved[part]["size_px"] == [640, 480]
            assert (saved[part]["fits"], saved[part]["why_not"]) == (True, "")
            assert saved[part]["date"]
        assert saved["session"]["pending_lens"] is saved["session"]["pending_plane"] is None
        assert load_rig_file(page.path).camera == page.rig.settings.camera
        assert 0.0 < page.position_error() < 0.02e-3
        state = await page.until(lambda state: state["tracking"] == "locked")
        assert state["pose"]["y_mm"] == pytest.approx(-42.0, abs=0.05)
        assert state["faults"] == []

        gone = await page.ask("DELETE", "/calibration")
        assert (gone["lens"], gone["plane"]) == (None, None)
        assert page.position_error() < 1e-12


async def test_a_lens_alone_takes_the_plane_out_that_was_found_with_another(serve, tmp_path):
    async with wizard(serve, tmp_path / "rig.toml") as page:
        await page.show("flat")
        await page.ask("POST", "/calibration/plane", method="board")
        saved = await page.ask("POST", "/calibration/save")
        assert saved["lens"] is None
        assert saved["plane"]["lens_date"] == ""
        await page.ask("PATCH", "/rig", camera={"height_mm": 300.0})
        state = await page.until(lambda state: state["faults"])
        assert [fault["code"] for fault in state["faults"]][:1] == ["calibration"]
        plane = (await page.ask("GET", "/calibration"))["plane"]
        assert plane["fits"] is False
        assert "another lens than the one in use: calibrate the plane again" in plane["why_not"]


async def test_without_a_board_or_views_one_is_told_what_to_do(serve, tmp_path):
    async with wizard(serve, tmp_path / "rig.toml") as page:
        await page.until(lambda state: state["tracking"] == "locked")
        none = await page.ask("POST", "/calibration/lens/views", 422)
        assert none["title"] == "No board"
        assert "light it evenly" in none["detail"]
        assert (
            "light it evenly" in (await page.ask("POST", "/calibration/plane", 422, method="board"))["detail"]
        )
        few = await page.ask("POST", "/calibration/lens", 422)
        assert "at least 6 different views" in few["detail"]
        nothing = await page.ask("POST", "/calibration/save", 409)
        assert "nothing to save" in nothing["detail"]
        assert not page.path.exists()


async def test_clicked_corners_and_marks_give_a_plane_with_an_honest_word_about_the_lens(serve, tmp_path):
    async with wizard(serve, tmp_path / "rig.toml") as page:
        optics = page.rig.machine.camera_model
        corners = [
            list(optics.to_pixel(x, y))
            for x, y in ((-0.05, 0.05), (0.05, 0.05), (0.05, -0.05), (-0.05, -0.05))
        ]
        body = {"method": "corners", "points_px": corners, "width_mm": 100.0, "height_mm": 100.0}
        plane = (await page.ask("POST", "/calibration/plane", **body))["pending_plane"]
        assert plane["scale_px_mm"] == pytest.approx(optics.scale_at(0.0, 0.0) * 1e-3, rel=1e-4)
        assert plane["residual_mm"] > 0.05
        assert [word for word in plane["remarks"] if "the lens is not calibrated" in word]
        assert [word for word in plane["remarks"] if "four corners hardly check" in word]
        places = [(-40, -40), (40, -40), (40, 40), (-40, 40), (0, 10), (20, -30)]
        marks = [
            dict(zip("uv", optics.to_pixel(x * 1e-3, y * 1e-3), strict=True), x_mm=float(x), y_mm=float(y))
            for x, y in places
        ]
        plane = (await page.ask("POST", "/calibration/plane", method="marks", marks=marks))["pending_plane"]
        assert plane["residual_mm"] < 0.001
        line = [{**mark, "y_mm": 0.0} for mark in marks]
        assert (
            "on one line"
            in (await page.ask("POST", "/calibration/plane", 422, method="marks", marks=line))["detail"]
        )


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


async def test_a_board_that_moves_is_no_view_and_no_plane(serve, tmp_path):
    async with wizard(serve, tmp_path / "rig.toml") as page:
        camera, settings = page.rig.machine.camera, page.rig.settings.camera
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


async def test_another_camera_s_calibration_keeps_the_rig_from_arming_and_both_are_named(serve, tmp_path):
    path = tmp_path / "rig.toml"
    async with wizard(serve, path) as page:
        await page.show("flat")
        await page.ask("POST", "/calibration/plane", method="board")
        await page.ask("POST", "/calibration/save")
    path.write_text(path.read_text().replace('"simulated camera"', '"usb 046d:0825 ABC123"'))
    async with wizard(serve, path) as page:
        state = await page.until(lambda state: state["tracking"] == "locked")
        assert [fault["code"] for fault in state["faults"]] == ["calibration"]
        refused = await page.ask("POST", "/arm", 409)
        assert '"usb 046d:0825 ABC123"' in refused["detail"]
        assert '"simulated camera"' in refused["detail"]
        assert (await page.ask("GET", "/calibration"))["plane"]["fits"] is False
        await page.ask("DELETE", "/calibration")
        await page.until(lambda state: state["tracking"] == "locked" and not state["faults"])
        await page.ask("POST", "/arm")


async def test_a_real_camera_s_calibration_is_left_alone_by_a_server_that_simulates_it(serve, tmp_path):
    path = tmp_path / "rig.toml"
    path.write_text('[camera]\nuri = "v4l://0"\n[link]\nport = "/dev/ttyACM0"\n')
    async with wizard(serve, path, lambda settings: settings.as_simulated()) as page:
        await page.show("flat")
        await page.ask("POST", "/calibration/plane", method="board")
        refused = await page.ask("POST", "/calibration/save", 409)
        assert "--sim" in refused["detail"]
    assert "plane" not in path.read_text()


async def test_views_are_forgotten_on_request_and_with_another_board(serve, tmp_path):
    async with wizard(serve, tmp_path / "rig.toml") as page:
        await page.show("flat")
        assert (await page.ask("POST", "/calibration/lens/views"))["views"] == 1
        assert (await page.ask("DELETE", "/calibration/lens/views"))["session"]["views"] == 0
        assert (await page.ask("POST", "/calibration/lens/views"))["views"] == 1
        await page.ask("PATCH", "/rig", camera={"board": {"square_mm": 11.9}})
        assert (await page.ask("GET", "/calibration"))["session"]["views"] == 0


async def test_the_board_comes_as_a_pdf_of_any_size(api):
    own = await api.get("/calibration/board.pdf")
    assert own.headers["content-type"] == "application/pdf"
    assert own.content.startswith(b"%PDF-1.4")
    assert b"14 x 12 squares of 12 mm" in own.content
    other = await api.get("/calibration/board.pdf", params={"columns": 8, "rows": 6, "square_mm": 20.0})
    assert b"8 x 6 squares of 20 mm" in other.content
    for wrong in ({"columns": 2}, {"square_mm": "nan"}, {"rows": 1000}):
        assert (await api.get("/calibration/board.pdf", params=wrong)).status_code == 422
