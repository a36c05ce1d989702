"""Lens and plane over REST, on the simulated rig with the printed board before its camera."""

import pytest
from calibration_visit import wizard

from server.rig_file import load_rig_file

pytestmark = pytest.mark.anyio

ENOUGH = 7
"""Views: the lens needs 6."""


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


def is_refused_for_its_calibration_alone(state):
    return state["tracking"] == "locked" and [fault["code"] for fault in state["faults"]] == ["calibration"]


async def test_another_camera_s_calibration_keeps_the_rig_from_arming_and_both_are_named(serve, tmp_path):
    path = tmp_path / "rig.toml"
    async with wizard(serve, path) as page:
        await page.show("flat")
        await page.ask("POST", "/calibration/plane", method="board")
        await page.ask("POST", "/calibration/save")
    path.write_text(path.read_text().replace('"simulated camera"', '"usb 046d:0825 ABC123"'))
    async with wizard(serve, path) as page:
        await page.until(is_refused_for_its_calibration_alone)
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
